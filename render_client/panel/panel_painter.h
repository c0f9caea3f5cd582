// Draws the control panel over a finished picture, in any OpenGL 3.3 core context.
//
// It belongs to the thread of the context, which must be current for every call. Leaves blending
// and scissors off.
#pragma once

#include <map>

#include "render_client/gl/gl_object.h"
#include "render_client/gl/program.h"
#include "render_client/panel/panel.h"

namespace bonemill {

class PanelPainter {
  public:
    // Throws GlError.
    explicit PanelPainter(const GlApi& gl);

    // Draws into the bound framebuffer of this size (pixels). A closed panel draws nothing.
    void paint(const Panel& panel, int width, int height);

  private:
    void uploadFont(const Panel::FontPixels& font);
    void smooth();
    void uploadPictures(const Panel& panel);
    void prepare(int width, int height);

    const GlApi& gl_;
    Program program_;
    GlVertexArray layout_;
    GlBuffer vertices_;
    GlBuffer indices_;
    GlTexture font_;
    std::map<int, GlTexture> pictures_;  // by number
    int font_version_ = 0;               // of the pixels in the texture; 0: none
};

}  // namespace bonemill
