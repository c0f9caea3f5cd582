// Draws the screen of the window to begin in, in any OpenGL 3.3 core context.
//
// It belongs to the thread of the context, which must be current for every call.
#pragma once

#include <map>

#include "render_client/look/gl/gl_api.h"
#include "render_client/panel/imgui/imgui_stage.h"
#include "render_client/start_window/start_screen/start_screen.h"

namespace bonemill {

class StartPainter {
  public:
    // Throws GlError.
    explicit StartPainter(const GlApi& gl) : gl_(gl), painter_(gl) {}

    // Draws into framebuffer 0 of this size (pixels).
    void paint(const StartScreen& screen, int width, int height);

  private:
    void upload(const CardPictures& pictures);

    const GlApi& gl_;
    ImGuiPainter painter_;
    std::map<int, GlTexture> textures_;  // by the picture's number
};

}  // namespace bonemill
