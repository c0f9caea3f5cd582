// Draws the screen of make-case's window in any OpenGL 3.3 core context.
//
// It belongs to the thread of the context, which must be current for every call.
#pragma once

#include <array>

#include "render_client/case_window/case_desk/scan_slice.h"
#include "render_client/case_window/case_screen/bone_preview.h"
#include "render_client/case_window/case_screen/case_screen.h"
#include "render_client/panel/imgui/imgui_painter.h"

namespace bonemill {

class ScreenPainter {
  public:
    // Throws GlError.
    explicit ScreenPainter(const GlApi& gl);

    // Draws into framebuffer 0 of this size (pixels). Only what has changed is computed anew.
    void paint(const CaseScreen& screen, const ImGuiStage& stage, const CaseDesk& desk, int width,
               int height);

  private:
    struct SeenSlice {  // in the texture
        const RawVolume* scan = nullptr;
        SlicePlane plane;
        SliceLook look;
    };
    void updateSlice(size_t axis, const CaseDesk& desk, const ScanPane& pane);

    const GlApi& gl_;
    ImGuiPainter painter_;
    BonePreview bone_;
    std::array<GlTexture, 3> textures_;
    std::array<SeenSlice, 3> seen_;
};

}  // namespace bonemill
