#include "render_client/look/paint/slice_painter.h"

#include "render_client/look/shaders/shaders.h"

namespace bonemill {
namespace {

constexpr float kNowhere = -1e6f;

}  // namespace

SlicePainter::SlicePainter(const GlApi& gl)
    : gl_(gl),
      program_(gl, "slice", shaders::kFullScreenVertex, shaders::kSliceFragment),
      no_attributes_(gl),
      textures_{GlTexture(gl), GlTexture(gl), GlTexture(gl)} {}

void SlicePainter::setPixels(size_t axis, const std::vector<uint8_t>& rgba, int width, int height) {
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindTexture(GL_TEXTURE_2D, textures_[axis].name());
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

void SlicePainter::paint(const std::array<Pane, 3>& panes, int columns, int width, int height,
                         GLuint target) const {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target);
    gl_.Enable(GL_SCISSOR_TEST);
    gl_.Scissor(width - columns, 0, columns, height);
    gl_.ClearColor(0.055f, 0.066f, 0.082f, 1);
    gl_.Clear(GL_COLOR_BUFFER_BIT);
    gl_.ClearColor(0, 0, 0, 1);
    gl_.Disable(GL_SCISSOR_TEST);
    gl_.Disable(GL_DEPTH_TEST);
    gl_.Disable(GL_BLEND);
    program_.use();
    program_.set("slice", 0);
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindVertexArray(no_attributes_.name());
    for (const Pane& pane : panes) {
        const PaneRect& rect = pane.rect;
        gl_.Viewport(rect.x, height - rect.y - rect.height, rect.width, rect.height);
        gl_.BindTexture(GL_TEXTURE_2D, textures_[pane.axis].name());
        program_.set("size", Eigen::Vector2f(float(rect.width), float(rect.height)));
        program_.set("burr", pane.cross ? Eigen::Vector2f(pane.cross->cast<float>())
                                        : Eigen::Vector2f(kNowhere, kNowhere));
        program_.set("circle", float(pane.circle));
        gl_.DrawArrays(GL_TRIANGLES, 0, 3);
    }
    gl_.BindVertexArray(0);
    gl_.Viewport(0, 0, width, height);
    gl_.check("drawing the slices");
}

}  // namespace bonemill
