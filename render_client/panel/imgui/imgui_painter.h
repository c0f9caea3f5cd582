// Draws what Dear ImGui has laid out over a finished picture, in any OpenGL 3.3 core context.
//
// It belongs to the thread of the context, which must be current for every call. Leaves blending and scissors
// off.
#pragma once

#include <map>

#include "render_client/look/gl/gl_object.h"
#include "render_client/look/gl/program.h"
#include "render_client/panel/imgui/imgui_stage.h"

namespace bonemill {

// Where a drawing names one of these numbers it shows this texture; any other number is the font.
using ImGuiTextures = std::map<int, GLuint>;

class ImGuiPainter {
  public:
    // Throws GlError.
    explicit ImGuiPainter(const GlApi& gl);

    // Draws into the bound framebuffer of this size (pixels).
    void paint(const ImDrawData& drawing, const ImGuiStage::FontPixels& font, const ImGuiTextures& textures,
               int width, int height);

  private:
    void uploadFont(const ImGuiStage::FontPixels& font);
    void smooth();
    void prepare(int width, int height);

    const GlApi& gl_;
    Program program_;
    GlVertexArray layout_;
    GlBuffer vertices_;
    GlBuffer indices_;
    GlTexture font_;
    int font_version_ = 0;  // of the pixels in the texture; 0: none
};

}  // namespace bonemill
