// Boxes and text of the head-up display as triangles, with colours and glyphs; how they are drawn is
// elsewhere. They are plain values, for one thread.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "render_client/look/hud/hud.h"

namespace bonemill {

enum class FontStyle { kPlain, kBold };

// Returns the path of the installed file that figures and panel are written in. Throws UserError when it is
// not installed.
std::string fontFile(FontStyle style);

// Returns the code points of UTF-8 text; each broken byte becomes U+FFFD.
std::vector<uint32_t> decodeUtf8(std::string_view text);

struct Glyph {
    float x0, y0, x1, y1;  // pixels from the pen on the base line, y down
    float u0, v0, u1, v1;  // its place in the picture, 0 to 1
    float advance;         // pixels
};

// It has the glyphs of DejaVu Sans, plain and bold, at one height: their shapes in one picture, and their
// measures. After construction it is plain values, for any thread.
class FontAtlas {
  public:
    // Takes Latin-1 and a few signs at this height (pixels). Throws UserError when the font files are not
    // installed, and std::runtime_error when they cannot be used.
    explicit FontAtlas(float pixel_height);

    const Glyph& glyph(uint32_t code_point, FontStyle style) const;  // '?' for a sign that it does not have
    float width(std::string_view utf8, FontStyle style) const;       // pixels
    float pixelHeight() const { return pixel_height_; }

    // The picture has size() rows of size() bytes, 255 where a glyph is.
    const std::vector<uint8_t>& pixels() const { return pixels_; }
    int size() const { return size_; }

  private:
    float pixel_height_;
    int size_;
    std::vector<uint8_t> pixels_;
    std::array<std::vector<Glyph>, 2> glyphs_;  // by style
};

// The colours of figures and panel are red, green, blue and opacity, each from 0 to 1.
using HudColour = std::array<float, 4>;

inline constexpr HudColour kHudPanelColour{0.03f, 0.045f, 0.06f, 0.74f};
inline constexpr HudColour kHudLabelColour{0.62f, 0.68f, 0.74f, 1};
inline constexpr HudColour kHudTitleColour{1, 1, 1, 1};
inline constexpr HudColour kHudHeadingColour{0.55f, 0.78f, 1, 1};
inline constexpr HudColour kHudLineColour{1, 1, 1, 0.14f};
inline constexpr HudColour kHudScaleColour{0.92f, 0.94f, 0.96f, 0.9f};
inline constexpr HudColour kHudPointerNameColour{1, 0.62f, 0.88f, 1};

HudColour colourOf(HudTone tone);

// Positions are pixels from the picture's upper left corner.
class HudCanvas {
  public:
    // The shader of the head-up display takes this. A glyph has its place in the font's picture in (u, v) and
    // a negative radius; a box has the distance from its middle there.
    struct Vertex {
        float x, y, u, v;
        float r, g, b, a;
        float half_width, half_height, radius;
    };

    // Begins an empty canvas to be written on in this font, which must outlive it.
    explicit HudCanvas(const FontAtlas& font) : font_(font) {}

    // The height of the font (pixels) is the unit of the layout.
    float em() const { return font_.pixelHeight(); }
    float width(std::string_view utf8, FontStyle style) const { return font_.width(utf8, style); }
    // Returns the text, cut short with an ellipsis where it is wider than N pixels.
    std::string fitted(const std::string& utf8, FontStyle style, float most) const;

    // Adds a box with rounded corners; a radius of 0 leaves them sharp.
    void box(float x, float y, float width, float height, float radius, const HudColour& colour);
    // Adds a straight line with flat ends.
    void line(const Eigen::Vector2f& from, const Eigen::Vector2f& to, float thickness,
              const HudColour& colour);
    // Adds the text from x on; y is the base line.
    void text(float x, float y, std::string_view utf8, FontStyle style, const HudColour& colour);

    const FontAtlas& font() const { return font_; }
    const std::vector<Vertex>& vertices() const { return vertices_; }

  private:
    void quad(const std::array<float, 4>& rectangle, const std::array<float, 4>& uv, const HudColour& colour,
              const std::array<float, 3>& shape);

    const FontAtlas& font_;
    std::vector<Vertex> vertices_;
};

// Text is so much larger than in a picture of 1280x800 pixels: it grows with the picture, whatever the
// desktop is set to, and is no smaller than can be read on this desktop. `chosen` is the user's own factor.
float textScale(int width, int height, double chosen = 1, float desktop_scale = 1);

}  // namespace bonemill
