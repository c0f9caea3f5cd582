#include "render_client/look/hud/hud_canvas.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "common/base/user_error.h"
#include "render_client/look/hud/figure_text.h"
#include "render_client/look/hud/palette.h"

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

constexpr float kGlyph = -1;   // the radius that marks a glyph in the shader
constexpr float kEdge = 0.5f;  // pixels more on each side of a box, so that its soft edge has room

}  // namespace

std::string fontFile(FontStyle style) {
    const std::string path = std::string(BONEMILL_FONT_DIR) +
                             (style == FontStyle::kPlain ? "/DejaVuSans.ttf" : "/DejaVuSans-Bold.ttf");
    if (!std::filesystem::exists(path))
        throw UserError("cannot read the font " + path + ": install the package fonts-dejavu-core");
    return path;
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

float textScale(int width, int height, double chosen, float desktop_scale) {
    constexpr float kUsualWidth = 1280, kUsualHeight = 800, kSmallestText = 0.7f;
    const float fitting = std::min(float(width) / kUsualWidth, float(height) / kUsualHeight);
    return std::max(fitting, kSmallestText * desktop_scale) * float(chosen);
}

HudColour colourOf(HudTone tone) {
    const Srgb& colour = palette().tones[size_t(tone)];
    return {float(colour[0]), float(colour[1]), float(colour[2]), 1};
}

void HudCanvas::box(float x, float y, float width, float height, float radius, const HudColour& colour) {
    const float half_width = width / 2, half_height = height / 2;
    quad({x - kEdge, y - kEdge, x + width + kEdge, y + height + kEdge},
         {-half_width - kEdge, -half_height - kEdge, half_width + kEdge, half_height + kEdge}, colour,
         {half_width, half_height, radius});
}

void HudCanvas::line(const Eigen::Vector2f& from, const Eigen::Vector2f& to, float thickness,
                     const HudColour& colour) {
    const Eigen::Vector2f half = (to - from) / 2, middle = (from + to) / 2;
    const float half_length = half.norm(), half_width = thickness / 2;
    if (half_length <= 0) return;
    const Eigen::Vector2f along = half / half_length, across(-along.y(), along.x());
    const auto corner = [&](float u, float v) {
        const Eigen::Vector2f p = middle + u * along + v * across;
        return Vertex{p.x(),     p.y(),     u,           v,          colour[0], colour[1],
                      colour[2], colour[3], half_length, half_width, 0};
    };
    const float u = half_length + kEdge, v = half_width + kEdge;
    const Vertex corners[] = {corner(-u, -v), corner(u, -v), corner(-u, v), corner(u, v)};
    for (const int i : {0, 2, 1, 1, 2, 3}) vertices_.push_back(corners[i]);
}

void HudCanvas::text(float x, float y, std::string_view utf8, FontStyle style, const HudColour& colour) {
    y = std::round(y);
    for (const uint32_t code_point : decodeUtf8(utf8)) {
        const Glyph& g = font_.glyph(code_point, style);
        quad({x + g.x0, y + g.y0, x + g.x1, y + g.y1}, {g.u0, g.v0, g.u1, g.v1}, colour, {0, 0, kGlyph});
        x += g.advance;
    }
}

std::string HudCanvas::fitted(const std::string& utf8, FontStyle style, float most) const {
    constexpr size_t kMaxSigns = 160;  // no line of a picture is longer
    const std::string start = shortenedText(utf8, kMaxSigns);
    std::string text = start;
    for (size_t signs = decodeUtf8(start).size(); signs > 1 && width(text, style) > most; --signs)
        text = shortenedText(start, signs - 1);
    return text;
}

void HudCanvas::quad(const std::array<float, 4>& rectangle, const std::array<float, 4>& uv,
                     const HudColour& colour, const std::array<float, 3>& shape) {
    const auto corner = [&](size_t x, size_t y) {
        return Vertex{rectangle[x], rectangle[y], uv[x],    uv[y],    colour[0], colour[1],
                      colour[2],    colour[3],    shape[0], shape[1], shape[2]};
    };
    const Vertex corners[] = {corner(0, 1), corner(2, 1), corner(0, 3), corner(2, 3)};
    for (const int i : {0, 2, 1, 1, 2, 3}) vertices_.push_back(corners[i]);
}

}  // namespace bonemill
