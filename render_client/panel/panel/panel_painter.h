// Draws the control panel over a finished picture, in any OpenGL 3.3 core context.
//
// It belongs to the thread of the context, which must be current for every call. Leaves blending
// and scissors off.
#pragma once

#include <map>

#include "render_client/look/gl/gl_object.h"
#include "render_client/panel/imgui/imgui_painter.h"
#include "render_client/panel/panel/panel.h"

namespace bonemill {

class PanelPainter {
  public:
    // Throws GlError.
    explicit PanelPainter(const GlApi& gl) : gl_(gl), painter_(gl) {}

    // Draws into the bound framebuffer of this size (pixels). A closed panel draws nothing.
    void paint(const Panel& panel, int width, int height);

  private:
    void uploadPictures(const Panel& panel);

    const GlApi& gl_;
    ImGuiPainter painter_;
    std::map<int, GlTexture> pictures_;  // by number
};

}  // namespace bonemill
