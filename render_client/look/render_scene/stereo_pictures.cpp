// RenderScene in stereo: a picture for each eye.
#include "render_client/look/render_scene/render_scene.h"

namespace bonemill {

void RenderScene::drawSideBySide(const FrameView& view, int width, int height, float ui_scale,
                                 GLuint target) {
    const StereoPair eyes = stereoPair(view.camera);
    const int half = width / 2;
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target);
    gl_.ClearColor(0, 0, 0, 1);
    gl_.Clear(GL_COLOR_BUFFER_BIT);  // the last column of an odd width belongs to neither eye
    for (const auto& [camera, x] : {std::pair{eyes.left, 0}, std::pair{eyes.right, half}}) {
        const PictureArea area{x, half, height};
        drawEye(view, camera, area, ui_scale, target);
        paintHud(camera, area, ui_scale);
    }
    gl_.Viewport(0, 0, width, height);
}

void RenderScene::drawAnaglyph(const FrameView& view, int width, int height, float ui_scale, GLuint target) {
    const StereoPair eyes = stereoPair(view.camera);
    const PictureArea whole{0, width, height};
    anaglyph_.resize(width, height);
    drawEye(view, eyes.left, whole, ui_scale, anaglyph_.left());
    drawEye(view, eyes.right, whole, ui_scale, anaglyph_.right());
    anaglyph_.combine(target);
    paintHud(view.camera, whole, ui_scale);
}

}  // namespace bonemill
