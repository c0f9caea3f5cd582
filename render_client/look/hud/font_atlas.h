// It has the glyphs of DejaVu Sans, plain and bold, at one height: their shapes in one picture, and their
// measures. After construction it is plain values, for any thread.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "render_client/look/hud/font_files.h"

namespace bonemill {

struct Glyph {
    float x0, y0, x1, y1;  // pixels from the pen on the base line, y down
    float u0, v0, u1, v1;  // its place in the picture, 0 to 1
    float advance;         // pixels
};

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

}  // namespace bonemill
