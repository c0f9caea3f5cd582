// Makes boxes and text of the head-up display into triangles; how they are drawn is elsewhere. Positions are
// pixels from the picture's upper left corner. It is a plain value, for one thread.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "render_client/look/hud/font_atlas.h"
#include "render_client/look/hud/hud_colours.h"

namespace bonemill {

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

}  // namespace bonemill
