#include "render_client/look/hud/font_atlas.h"

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "render_client/look/hud/utf8.h"

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wsign-compare"
#endif
#define STB_RECT_PACK_IMPLEMENTATION
#define STBRP_STATIC
#include <stb/stb_rect_pack.h>
#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <stb/stb_truetype.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace bonemill {
namespace {

struct CodeRange {
    uint32_t first;
    uint32_t count;
};
constexpr CodeRange kRanges[] = {
    {0x20, 95}, {0xa0, 96}, {0x2013, 1}, {0x2026, 1}};  // ASCII, Latin-1, dash, ellipsis

constexpr uint32_t kNoGlyph = UINT32_MAX;
uint32_t glyphIndex(uint32_t code_point) {
    uint32_t start = 0;
    for (const CodeRange& range : kRanges) {
        if (code_point >= range.first && code_point < range.first + range.count) {
            return start + code_point - range.first;
        }
        start += range.count;
    }
    return kNoGlyph;
}

std::vector<unsigned char> readFont(FontStyle style) {
    const std::string path = fontFile(style);
    std::ifstream file(path, std::ios::binary);
    std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (bytes.empty()) throw std::runtime_error("cannot read the font " + path);
    return bytes;
}

std::vector<Glyph> packStyle(stbtt_pack_context& context, const unsigned char* font, float pixel_height,
                             int size) {
    std::vector<Glyph> glyphs;
    for (const CodeRange& range : kRanges) {
        std::vector<stbtt_packedchar> packed(range.count);
        if (!stbtt_PackFontRange(&context, font, 0, pixel_height, int(range.first), int(range.count),
                                 packed.data())) {
            throw std::runtime_error("the font does not fit its picture");
        }
        for (int i = 0; i < int(range.count); ++i) {
            float x = 0, y = 0;
            stbtt_aligned_quad q;
            stbtt_GetPackedQuad(packed.data(), size, size, i, &x, &y, &q, 0);
            glyphs.push_back({q.x0, q.y0, q.x1, q.y1, q.s0, q.t0, q.s1, q.t1, packed[size_t(i)].xadvance});
        }
    }
    return glyphs;
}

}  // namespace

FontAtlas::FontAtlas(float pixel_height)
    : pixel_height_(pixel_height),
      // There is room for 400 glyphs, oversampled 2 x 2, of about pixel_height x 0.7 pixel_height each.
      size_(pixel_height <= 24   ? 1024
            : pixel_height <= 48 ? 2048
                                 : 4096),
      pixels_(size_t(size_) * size_t(size_)) {
    stbtt_pack_context context;
    if (!stbtt_PackBegin(&context, pixels_.data(), size_, size_, 0, 1, nullptr))
        throw std::runtime_error("no memory for the font");
    stbtt_PackSetOversampling(&context, 2, 2);
    for (const FontStyle style : {FontStyle::kPlain, FontStyle::kBold})
        glyphs_[size_t(style)] = packStyle(context, readFont(style).data(), pixel_height, size_);
    stbtt_PackEnd(&context);
}

const Glyph& FontAtlas::glyph(uint32_t code_point, FontStyle style) const {
    const uint32_t index = glyphIndex(code_point);
    return glyphs_[size_t(style)][index == kNoGlyph ? glyphIndex('?') : index];
}

float FontAtlas::width(std::string_view utf8, FontStyle style) const {
    float sum = 0;
    for (const uint32_t code_point : decodeUtf8(utf8)) sum += glyph(code_point, style).advance;
    return sum;
}

}  // namespace bonemill
