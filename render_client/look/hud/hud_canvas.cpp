#include "render_client/look/hud/hud_canvas.h"

#include <cmath>

#include "render_client/look/hud/figure_text.h"
#include "render_client/look/hud/utf8.h"

namespace bonemill {
namespace {

constexpr float kGlyph = -1;   // the radius that marks a glyph in the shader
constexpr float kEdge = 0.5f;  // pixels more on each side of a box, so that its soft edge has room

}  // namespace

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
