#include "render_client/case_window/case_screen/screen_painter.h"

#include <imgui.h>

namespace bonemill {
namespace {

SliceLook lookOf(const CaseDesk& desk) {
    SliceLook look;
    look.window = desk.window;
    look.iso = desk.iso();
    if (desk.isBoneOfNow()) look.bone = desk.bone();
    look.labels = desk.labels();
    for (size_t row = 0; row < desk.structures().size(); ++row)
        if (desk.structures()[row].use != StructureUse::kIgnored)
            for (const uint32_t label : desk.structures()[row].labels)
                look.label_tints[label] = structureTint(row);
    return look;
}

}  // namespace

ScreenPainter::ScreenPainter(const GlApi& gl)
    : gl_(gl), painter_(gl), bone_(gl), textures_{GlTexture(gl), GlTexture(gl), GlTexture(gl)} {}

void ScreenPainter::updateSlice(size_t axis, const CaseDesk& desk, const ScanPane& pane) {
    const SeenSlice now{desk.scan(), pane.plane(desk.scan()->geometry.X_WV), lookOf(desk)};
    if (seen_[axis].scan == now.scan && seen_[axis].plane == now.plane && seen_[axis].look == now.look)
        return;
    const RgbaImage image = drawSlice(*now.scan, now.plane, now.look);
    seen_[axis] = now;
    gl_.BindTexture(GL_TEXTURE_2D, textures_[axis].name());
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, image.width, image.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                   image.rgba.data());
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        gl_.TexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
        gl_.TexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
}

void ScreenPainter::paint(const CaseScreen& screen, const ImGuiStage& stage, const CaseDesk& desk, int width,
                          int height) {
    gl_.ActiveTexture(GL_TEXTURE0);
    ImGuiTextures textures{{kBonePicture, bone_.texture()}};
    for (size_t axis = 0; axis < textures_.size(); ++axis) {
        if (desk.scan())
            updateSlice(axis, desk, screen.panes()[axis]);
        else
            seen_[axis] = {};  // another scan may come to lie at the same place of the memory
        textures[kSlicePictures[axis]] = textures_[axis].name();
    }
    bone_.paint(desk, screen.camera(), screen.boneWidth(), screen.boneHeight());
    gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl_.Viewport(0, 0, width, height);
    gl_.ClearColor(0.03f, 0.04f, 0.05f, 1);
    gl_.Clear(GL_COLOR_BUFFER_BIT);
    if (screen.drawData()) painter_.paint(*screen.drawData(), stage.fontPixels(), textures, width, height);
}

}  // namespace bonemill
