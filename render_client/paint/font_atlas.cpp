#include "render_client/paint/font_atlas.h"

#include <fstream>
#include <iterator>
#include <string>

#include "common/user_error.h"

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

std::vector<unsigned char> readFont(const char* path) {
    std::ifstream file(path, std::ios::binary);
    std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (bytes.empty()) {
        throw UserError(std::string("cannot read the font ") + path +
                        ": install the package fonts-dejavu-core");
    }
    return bytes;
}

std::vector<Glyph> packStyle(stbtt_pack_context& context, const unsigned char* font, float pixel_height,
                             int size) {
    std::vector<Glyph> glyphs;
    for (const CodeRange& range : kRanges) {
        std::vector<stbtt_packedchar> packed(range.count);
        if (!stbtt_PackFontRange(&context, font, 0, pixel_height, int(range.first), int(range.count),
                                 packed.data())) {
            throw GlError("the font does not fit its texture");
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

FontAtlas::FontAtlas(const GlApi& gl, float pixel_height) : pixel_height_(pixel_height), texture_(gl) {
    const auto plain = readFont(BONEMILL_FONT_DIR "/DejaVuSans.ttf");
    const auto bold = readFont(BONEMILL_FONT_DIR "/DejaVuSans-Bold.ttf");
    // 400 glyphs, oversampled 2 x 2, of about pixel_height x 0.7 pixel_height each.
    const int size = pixel_height <= 24 ? 1024 : pixel_height <= 48 ? 2048 : 4096;
    std::vector<unsigned char> pixels(size_t(size) * size_t(size));
    stbtt_pack_context context;
    if (!stbtt_PackBegin(&context, pixels.data(), size, size, 0, 1, nullptr))
        throw GlError("no memory for the font");
    stbtt_PackSetOversampling(&context, 2, 2);
    glyphs_[size_t(FontStyle::kPlain)] = packStyle(context, plain.data(), pixel_height, size);
    glyphs_[size_t(FontStyle::kBold)] = packStyle(context, bold.data(), pixel_height, size);
    stbtt_PackEnd(&context);

    gl.BindTexture(GL_TEXTURE_2D, texture_.name());
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_R8, size, size, 0, GL_RED, GL_UNSIGNED_BYTE, pixels.data());
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
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

std::vector<uint32_t> decodeUtf8(std::string_view text) {
    constexpr uint32_t kReplacement = 0xfffd;
    std::vector<uint32_t> code_points;
    for (size_t i = 0; i < text.size();) {
        const auto lead = uint8_t(text[i]);
        const size_t length = lead < 0x80         ? 1
                              : lead >> 5 == 0x6  ? 2
                              : lead >> 4 == 0xe  ? 3
                              : lead >> 3 == 0x1e ? 4
                                                  : 0;
        uint32_t code_point = length <= 1 ? lead : lead & (0x7fu >> length);
        bool valid = length > 0 && i + length <= text.size();
        for (size_t k = 1; valid && k < length; ++k) {
            const auto byte = uint8_t(text[i + k]);
            valid = byte >> 6 == 0x2;
            code_point = code_point << 6 | (byte & 0x3fu);
        }
        code_points.push_back(valid ? code_point : kReplacement);
        i += valid ? length : 1;
    }
    return code_points;
}

}  // namespace bonemill
