#include "render_client/paint/hud_painter.h"

#include <algorithm>
#include <cmath>

#include "render_client/paint/shaders.h"

namespace bonemill {
namespace {

constexpr float kFontPixels = 15;  // at ui_scale 1
constexpr std::array<float, 4> kPanelColour{0.03f, 0.045f, 0.06f, 0.74f};
constexpr std::array<float, 4> kLabelColour{0.62f, 0.68f, 0.74f, 1};
constexpr std::array<float, 4> kTitleColour{1, 1, 1, 1};
constexpr std::array<float, 4> kLineColour{1, 1, 1, 0.14f};
constexpr std::array<float, 4> kPointerName{1, 0.62f, 0.88f, 1};
constexpr std::string_view kWatchersTitle = "Watching";
constexpr float kHelpPadding = 1.4f, kHelpLine = 1.7f, kHelpGap = 2;  // of the text's height
constexpr float kSmallestHelp = 7;                                    // pixels: what can just be read
constexpr float kGlyph = -1;                                          // marks a glyph in the shader

}  // namespace

HudPainter::HudPainter(const GlApi& gl)
    : gl_(gl), program_(gl, "hud", shaders::kHudVertex, shaders::kHudFragment), layout_(gl), buffer_(gl) {
    gl_.BindVertexArray(layout_.name());
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    constexpr struct {
        GLuint index;
        GLint size;
        size_t offset;
    } kAttributes[] = {{0, 2, offsetof(Vertex, x)},
                       {1, 2, offsetof(Vertex, u)},
                       {2, 4, offsetof(Vertex, r)},
                       {3, 3, offsetof(Vertex, half_width)}};
    for (const auto& a : kAttributes) {
        gl_.VertexAttribPointer(a.index, a.size, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                                reinterpret_cast<const void*>(a.offset));
        gl_.EnableVertexAttribArray(a.index);
    }
    gl_.BindVertexArray(0);
}

void HudPainter::paint(const Hud& hud, const ScaleBar& scale_bar, double metres_per_pixel, int width,
                       int height, float ui_scale) {
    begin(ui_scale);
    const Corner panel = layOutPanel(hud);
    if (!hud.watchers.empty()) layOutWatchers(hud.watchers, panel, width);
    layOutScaleBar(scale_bar, metres_per_pixel, width, height);
    if (!hud.help.empty()) {
        flush(width, height);
        useFont(helpTextHeight(hud.help, width, height));
        layOutHelp(hud.help, width, height);
        flush(width, height);
        begin(ui_scale);
    }
    if (hud.notice) layOutNotice(*hud.notice, width, height);
    if (hud.alert) layOutAlert(*hud.alert, width, height);
    flush(width, height);
}

void HudPainter::paintAlert(const HudNotice& alert, int width, int height, float ui_scale) {
    begin(ui_scale);
    layOutAlert(alert, width, height);
    flush(width, height);
}

void HudPainter::paintLabels(const std::vector<HudLabel>& labels, int width, int height, float ui_scale) {
    begin(ui_scale);
    for (const HudLabel& label : labels) layOutLabel(label);
    flush(width, height);
}

void HudPainter::begin(float ui_scale) {
    useFont(std::round(kFontPixels * ui_scale));
}

void HudPainter::useFont(float em) {
    em_ = em;
    std::unique_ptr<FontAtlas>& font = fonts_[em];
    if (!font) font = std::make_unique<FontAtlas>(gl_, em);
    font_ = font.get();
    vertices_.clear();
}

void HudPainter::layOutLabel(const HudLabel& label) {
    const float text_width = font_->width(label.text, FontStyle::kBold);
    const float padding = em_ * 0.45f, left = std::round(label.x) + em_ * 1.7f;
    const float top = std::round(label.y) - em_ * 0.75f;
    box(left - padding, top, text_width + 2 * padding, em_ * 1.5f, em_ * 0.4f, kPanelColour);
    text(left, top + em_ * 1.08f, label.text, FontStyle::kBold, kPointerName);
}

// At the upper right, or below the panel when there is no room beside it.
void HudPainter::layOutWatchers(const std::vector<HudRow>& watchers, const Corner& panel, int width) {
    const float margin = em_ * 1.1f, padding = em_ * 0.9f, line = em_ * 1.55f, gap = em_ * 1.4f;
    float names = font_->width(kWatchersTitle, FontStyle::kBold), values = 0;
    for (const HudRow& row : watchers) {
        names = std::max(names, font_->width(row.label, FontStyle::kPlain));
        values = std::max(values, font_->width(row.value, FontStyle::kPlain));
    }
    const float inner = names + gap + values;
    const bool fits_beside = float(width) - 2 * margin - inner - 2 * padding > panel.right;
    const float left = fits_beside ? float(width) - margin - padding - inner : margin + padding;
    const float right = left + inner, top = fits_beside ? margin : panel.bottom + em_ * 0.6f;
    box(left - padding, top, inner + 2 * padding, line * float(watchers.size() + 1) + padding, em_ * 0.6f,
        kPanelColour);
    float base = top + padding * 0.7f + em_;
    text(left, base, kWatchersTitle, FontStyle::kBold, kTitleColour);
    for (const HudRow& row : watchers) {
        base += line;
        text(left, base, row.label, FontStyle::kPlain, kTitleColour);
        text(right - font_->width(row.value, FontStyle::kPlain), base, row.value, FontStyle::kPlain,
             row.tone == HudTone::kPlain ? kLabelColour : colourOf(row.tone));
    }
}

HudPainter::Corner HudPainter::layOutPanel(const Hud& hud) {
    const float margin = em_ * 1.1f, padding = em_ * 0.9f, line = em_ * 1.55f, gap = em_ * 1.4f;
    float label_width = 0, value_width = 0;
    for (const HudRow& row : hud.rows) {
        label_width = std::max(label_width, font_->width(row.label, FontStyle::kPlain));
        value_width = std::max(value_width, font_->width(row.value, FontStyle::kBold));
    }
    const float head_width = std::max(font_->width(hud.title, FontStyle::kBold),
                                      em_ * 0.9f + font_->width(hud.state, FontStyle::kPlain));
    // A floor keeps the panel from breathing with every digit.
    const float inner = std::max({head_width, label_width + gap + value_width, em_ * 13});
    const float head = line * 2 + em_ * 0.35f;
    const float body = hud.rows.empty() ? 0 : line * float(hud.rows.size()) + em_ * 0.5f;
    const Corner corner{margin + inner + 2 * padding, margin + head + body + 1.4f * padding};
    box(margin, margin, corner.right - margin, corner.bottom - margin, em_ * 0.6f, kPanelColour);

    const float left = margin + padding;
    float base = margin + padding * 0.7f + em_;
    text(left, base, hud.title, FontStyle::kBold, kTitleColour);
    base += line;
    const float dot = em_ * 0.5f;
    box(left, base - em_ * 0.55f, dot, dot, dot / 2, colourOf(hud.state_tone));
    text(left + em_ * 0.9f, base, hud.state, FontStyle::kPlain, kLabelColour);
    if (hud.rows.empty()) return corner;
    box(left, base + em_ * 0.65f, inner, 1, 0, kLineColour);
    base += em_ * 0.6f;
    for (const HudRow& row : hud.rows) {
        base += line;
        text(left, base, row.label, FontStyle::kPlain, kLabelColour);
        text(left + inner - font_->width(row.value, FontStyle::kBold), base, row.value, FontStyle::kBold,
             colourOf(row.tone));
    }
    return corner;
}

void HudPainter::layOutScaleBar(const ScaleBar& bar, double metres_per_pixel, int width, int height) {
    if (bar.length <= 0) return;
    const float pixels = float(bar.length / metres_per_pixel);
    const float right = float(width) - em_ * 1.6f, base = float(height) - em_ * 1.6f,
                thick = std::max(2.0f, em_ / 8);
    const Colour colour{0.92f, 0.94f, 0.96f, 0.9f};
    box(right - pixels, base, pixels, thick, 0, colour);
    box(right - pixels, base - em_ * 0.35f, thick, em_ * 0.35f, 0, colour);
    box(right - thick, base - em_ * 0.35f, thick, em_ * 0.35f, 0, colour);
    const float label_width = font_->width(bar.label, FontStyle::kPlain);
    text(right - (pixels + label_width) / 2, base - em_ * 0.6f, bar.label, FontStyle::kPlain, colour);
}

size_t HudPainter::helpRowsPerColumn(size_t rows, float em, int height) const {
    const float room = std::max(float(height) - 2 * em * kHelpPadding - em, em * kHelpLine);
    const auto columns = size_t(std::ceil(em * kHelpLine * float(rows) / room));
    return (rows + columns - 1) / columns;
}

std::vector<HudPainter::HelpColumn> HudPainter::helpColumns(const std::vector<HudRow>& rows,
                                                            size_t per_column) const {
    std::vector<HelpColumn> columns;
    for (size_t first = 0; first < rows.size(); first += per_column) {
        HelpColumn column{first, std::min(first + per_column, rows.size()), 0, 0};
        for (size_t i = first; i < column.end; ++i) {
            column.keys = std::max(column.keys, font_->width(rows[i].label, FontStyle::kBold));
            column.meanings = std::max(column.meanings, font_->width(rows[i].value, FontStyle::kPlain));
        }
        columns.push_back(column);
    }
    return columns;
}

float HudPainter::helpWidth(const std::vector<HelpColumn>& columns) const {
    float width = em_ * (2 * kHelpPadding - kHelpGap);
    for (const HelpColumn& column : columns) width += column.keys + column.meanings + 2 * em_ * kHelpGap;
    return width;
}

// Widths grow with the height of the text, near enough.
float HudPainter::helpTextHeight(const std::vector<HudRow>& rows, int width, int height) const {
    float em = em_;
    while (em > kSmallestHelp) {
        const auto columns = helpColumns(rows, helpRowsPerColumn(rows.size(), em, height));
        if (helpWidth(columns) * em / em_ <= float(width) - em) break;
        em = std::max(em - 1, kSmallestHelp);
    }
    return em;
}

void HudPainter::layOutHelp(const std::vector<HudRow>& rows, int width, int height) {
    const size_t per_column = helpRowsPerColumn(rows.size(), em_, height);
    const std::vector<HelpColumn> columns = helpColumns(rows, per_column);
    const float padding = em_ * kHelpPadding, line = em_ * kHelpLine, gap = em_ * kHelpGap;
    const float panel_width = helpWidth(columns);
    const float panel_height = line * float(per_column) + 2 * padding - em_ * 0.5f;
    const float left = std::round((float(width) - panel_width) / 2),
                top = std::round((float(height) - panel_height) / 2);
    Colour backing = kPanelColour;
    backing[3] = 0.86f;
    box(left, top, panel_width, panel_height, em_ * 0.6f, backing);
    float x = left + padding;
    for (const HelpColumn& column : columns) {
        float base = top + padding + em_ * 0.85f;
        for (size_t i = column.first; i < column.end; ++i, base += line) {
            text(x, base, rows[i].label, FontStyle::kBold, kTitleColour);
            text(x + column.keys + gap, base, rows[i].value, FontStyle::kPlain, kLabelColour);
        }
        x += column.keys + column.meanings + 2 * gap;
    }
}

void HudPainter::layOutNotice(const HudNotice& notice, int width, int height) {
    layOutBanner(notice, float(height) - em_ * 1.1f, width);
}

// Above the notice's place, so that neither hides the other.
void HudPainter::layOutAlert(const HudNotice& alert, int width, int height) {
    const float thick = std::max(3.0f, em_ * 0.4f), across = float(width), down = float(height);
    Colour colour = colourOf(alert.tone);
    colour[3] = 0.85f;
    box(0, 0, across, thick, 0, colour);
    box(0, down - thick, across, thick, 0, colour);
    box(0, thick, thick, down - 2 * thick, 0, colour);
    box(across - thick, thick, thick, down - 2 * thick, 0, colour);
    layOutBanner(alert, down - em_ * 3.9f, width);
}

void HudPainter::layOutBanner(const HudNotice& notice, float bottom, int width) {
    const float padding = em_ * 0.9f, panel_height = em_ * 2.2f;
    const float text_width = font_->width(notice.text, FontStyle::kBold);
    const float left = std::round((float(width) - text_width) / 2), top = bottom - panel_height;
    box(left - padding, top, text_width + 2 * padding, panel_height, em_ * 0.6f, kPanelColour);
    text(left, top + em_ * 1.45f, notice.text, FontStyle::kBold, colourOf(notice.tone));
}

void HudPainter::box(float x, float y, float width, float height, float radius, const Colour& colour) {
    const float half_width = width / 2, half_height = height / 2;
    // Half a pixel more on each side, so that the soft edge has room; a corner radius of 0 stays sharp.
    constexpr float kEdge = 0.5f;
    quad({x - kEdge, y - kEdge, x + width + kEdge, y + height + kEdge},
         {-half_width - kEdge, -half_height - kEdge, half_width + kEdge, half_height + kEdge}, colour,
         {half_width, half_height, radius});
}

float HudPainter::text(float x, float y, std::string_view utf8, FontStyle style, const Colour& colour) {
    y = std::round(y);
    for (const uint32_t code_point : decodeUtf8(utf8)) {
        const Glyph& g = font_->glyph(code_point, style);
        quad({x + g.x0, y + g.y0, x + g.x1, y + g.y1}, {g.u0, g.v0, g.u1, g.v1}, colour, {0, 0, kGlyph});
        x += g.advance;
    }
    return x;
}

void HudPainter::quad(const std::array<float, 4>& rectangle, const std::array<float, 4>& uv,
                      const Colour& colour, const std::array<float, 3>& shape) {
    const auto corner = [&](size_t x, size_t y) {
        return Vertex{rectangle[x], rectangle[y], uv[x],    uv[y],    colour[0], colour[1],
                      colour[2],    colour[3],    shape[0], shape[1], shape[2]};
    };
    const Vertex corners[] = {corner(0, 1), corner(2, 1), corner(0, 3), corner(2, 3)};
    for (const int i : {0, 2, 1, 1, 2, 3}) vertices_.push_back(corners[i]);
}

void HudPainter::flush(int width, int height) {
    gl_.Disable(GL_DEPTH_TEST);
    gl_.Disable(GL_CULL_FACE);
    gl_.Enable(GL_BLEND);
    gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    program_.use();
    program_.set("viewport", Eigen::Vector2f(float(width), float(height)));
    program_.set("font", 0);
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindTexture(GL_TEXTURE_2D, font_->texture());
    gl_.BindVertexArray(layout_.name());
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    gl_.BufferData(GL_ARRAY_BUFFER, GLsizeiptr(vertices_.size() * sizeof(Vertex)), vertices_.data(),
                   GL_STREAM_DRAW);
    gl_.DrawArrays(GL_TRIANGLES, 0, GLsizei(vertices_.size()));
    gl_.BindVertexArray(0);
    gl_.Disable(GL_BLEND);
}

HudPainter::Colour HudPainter::colourOf(HudTone tone) {
    switch (tone) {
        case HudTone::kGood:
            return {0.45f, 0.88f, 0.55f, 1};
        case HudTone::kWarning:
            return {1.0f, 0.76f, 0.30f, 1};
        case HudTone::kAlarm:
            return {1.0f, 0.42f, 0.38f, 1};
        case HudTone::kPlain:
            break;
    }
    return {0.95f, 0.96f, 0.97f, 1};
}

}  // namespace bonemill
