// Glyphs of DejaVu Sans, plain and bold, in one texture. Thread: the one of the context.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "render_client/gl/gl_object.h"

namespace bonemill {

enum class FontStyle { kPlain, kBold };

struct Glyph {
    float x0, y0, x1, y1;  // pixels from the pen on the base line, y down
    float u0, v0, u1, v1;
    float advance;  // pixels
};

class FontAtlas {
  public:
    // Latin-1 and a few signs at this height (pixels). Throws UserError when the font files are not
    // installed.
    FontAtlas(const GlApi& gl, float pixel_height);

    const Glyph& glyph(uint32_t code_point, FontStyle style) const;  // '?' for a sign it does not have
    float width(std::string_view utf8, FontStyle style) const;       // pixels
    float pixelHeight() const { return pixel_height_; }
    GLuint texture() const { return texture_.name(); }

  private:
    float pixel_height_;
    GlTexture texture_;
    std::array<std::vector<Glyph>, 2> glyphs_;  // by style
};

// Code points of UTF-8 text; a broken byte becomes U+FFFD.
std::vector<uint32_t> decodeUtf8(std::string_view text);

}  // namespace bonemill
