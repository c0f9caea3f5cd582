// Draws the panes with slices through the scan: their pixels, and where the burr is.
//
// It belongs to the thread of the context.
#pragma once

#include <array>

#include "render_client/look/gl/gl_object.h"
#include "render_client/look/gl/program.h"
#include "render_client/look/slices/panes.h"

namespace bonemill {

class SlicePainter {
  public:
    // Throws GlError with the compiler's log when the driver refuses the shader.
    explicit SlicePainter(const GlApi& gl);

    // Takes what the pane across that axis of W shows: red, green, blue and opacity per pixel, the upper row
    // first.
    void setPixels(size_t axis, const std::vector<uint8_t>& rgba, int width, int height);

    // Fills the last columns of the picture (pixels, in `target`) and draws the panes there. Leaves target
    // bound, and the viewport the whole picture.
    void paint(const std::array<Pane, 3>& panes, int columns, int width, int height, GLuint target) const;

  private:
    const GlApi& gl_;
    Program program_;
    GlVertexArray no_attributes_;
    std::array<GlTexture, 3> textures_;
};

}  // namespace bonemill
