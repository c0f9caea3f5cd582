#include "render_client/look/paint/hud_painter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "render_client/look/hud/hud_signs.h"
#include "render_client/look/shaders/shaders.h"

namespace bonemill {
namespace {

constexpr float kFontPixels = 15;  // at ui_scale 1
// Of that:
constexpr float kListText = 0.75f;  // whatever was asked for, or goes away by itself
constexpr float kMessageText = 0.87f;
constexpr float kMinFont = 7, kMaxFont = 90;  // pixels; the largest fits a font's picture
constexpr size_t kMaxFonts = 8;

}  // namespace

HudPainter::HudPainter(const GlApi& gl)
    : gl_(gl), program_(gl, "hud", shaders::kHudVertex, shaders::kHudFragment), layout_(gl), buffer_(gl) {
    using Vertex = HudCanvas::Vertex;
    gl_.BindVertexArray(layout_.name());
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    gl_.setFloats(0, 2, sizeof(Vertex), offsetof(Vertex, x));
    gl_.setFloats(1, 2, sizeof(Vertex), offsetof(Vertex, u));
    gl_.setFloats(2, 4, sizeof(Vertex), offsetof(Vertex, r));
    gl_.setFloats(3, 3, sizeof(Vertex), offsetof(Vertex, half_width));
    gl_.BindVertexArray(0);
}

HudPainter::Font::Font(const GlApi& gl, float pixel_height) : atlas(pixel_height), texture(gl) {
    gl.BindTexture(GL_TEXTURE_2D, texture.name());
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_R8, atlas.size(), atlas.size(), 0, GL_RED, GL_UNSIGNED_BYTE,
                  atlas.pixels().data());
    gl.setSampling(GL_TEXTURE_2D, GL_LINEAR);
}

const FontAtlas& HudPainter::usualFont(float ui_scale) {
    return fontOf(std::round(kFontPixels * ui_scale)).atlas;
}

const HudPainter::Font& HudPainter::fontOf(float pixel_height) {
    pixel_height = std::clamp(pixel_height, kMinFont, kMaxFont);
    return fonts_.try_emplace(pixel_height, gl_, pixel_height).first->second;
}

// Each part is drawn over the one before: the notices stand over the help page.
void HudPainter::paint(const Hud& hud, const ScaleBar& scale_bar, double metres_per_pixel,
                       const PictureSize& picture, float ui_scale) {
    if (fonts_.size() > kMaxFonts) fonts_.clear();  // a window that is drawn larger needs others
    const FontAtlas& font = usualFont(ui_scale);
    HudCanvas figures(font), lists(fontOf(std::round(kListText * font.pixelHeight())).atlas);
    HudBox box{};
    if (!hud.title.empty()) box = layOutFigures(figures, hud);
    if (hud.page) layOutPage(figures, *hud.page, picture);
    if (!hud.details.empty()) box = layOutDetails(lists, hud.details, box);
    layOutModes(lists, hud.modes, box);
    if (!hud.watchers.empty()) layOutWatchers(lists, hud.watchers, box, picture);
    layOutScaleBar(figures, scale_bar, metres_per_pixel, picture);
    if (hud.orientation) layOutOrientation(lists, *hud.orientation, picture);
    if (hud.legend) layOutLegend(lists, *hud.legend, picture);
    if (hud.hint) layOutHint(lists, *hud.hint, box, picture);
    draw(figures, picture);
    draw(lists, picture);
    if (!hud.help.empty()) {
        const auto groups = helpThatFits(font, hud.help, picture);
        HudCanvas help(fontOf(helpTextHeight(font, groups, picture)).atlas);
        layOutHelp(help, groups, picture);
        draw(help, picture);
    }
    HudCanvas messages(fontOf(std::round(kMessageText * font.pixelHeight())).atlas), alert(font);
    layOutMessages(messages, hud.messages, picture);
    if (hud.notice) layOutNotice(messages, *hud.notice, picture);
    draw(messages, picture);
    if (hud.alert) layOutAlert(alert, *hud.alert, picture);
    draw(alert, picture);
}

void HudPainter::paintAlert(const HudNotice& alert, const PictureSize& picture, float ui_scale) {
    HudCanvas canvas(usualFont(ui_scale));
    layOutAlert(canvas, alert, picture);
    draw(canvas, picture);
}

void HudPainter::paintLabels(const std::vector<HudLabel>& labels, const PictureSize& picture,
                             float ui_scale) {
    HudCanvas canvas(usualFont(ui_scale));
    for (const HudLabel& label : labels) layOutLabel(canvas, label);
    draw(canvas, picture);
}

void HudPainter::paintPanes(const std::vector<HudPane>& panes, const PictureSize& picture, float ui_scale) {
    HudCanvas canvas(fontOf(std::round(kListText * usualFont(ui_scale).pixelHeight())).atlas);
    for (const HudPane& pane : panes) layOutPane(canvas, pane);
    draw(canvas, picture);
}

void HudPainter::draw(const HudCanvas& canvas, const PictureSize& picture) {
    const std::vector<HudCanvas::Vertex>& vertices = canvas.vertices();
    if (vertices.empty()) return;
    const GLuint texture = fontOf(canvas.em()).texture.name();
    gl_.Disable(GL_DEPTH_TEST);
    gl_.Disable(GL_CULL_FACE);
    gl_.Enable(GL_BLEND);
    gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    program_.use();
    program_.set("viewport", Eigen::Vector2f(float(picture.width), float(picture.height)));
    program_.set("font", 0);
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindTexture(GL_TEXTURE_2D, texture);
    gl_.BindVertexArray(layout_.name());
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    gl_.BufferData(GL_ARRAY_BUFFER, GLsizeiptr(vertices.size() * sizeof(HudCanvas::Vertex)), vertices.data(),
                   GL_STREAM_DRAW);
    gl_.DrawArrays(GL_TRIANGLES, 0, GLsizei(vertices.size()));
    gl_.BindVertexArray(0);
    gl_.Disable(GL_BLEND);
}

}  // namespace bonemill
