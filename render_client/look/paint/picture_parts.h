// OpenGL is told which part of a picture a call is for. They belong to the thread of the context.
#pragma once

#include <vector>

#include "render_client/look/gl/gl_api.h"
#include "render_client/look/paint/pixel_tiles.h"

namespace bonemill {

// Drawing changes nothing outside of this part from now on; the test must be enabled.
inline void setScissor(const GlApi& gl, const PixelBox& part) {
    gl.Scissor(part.x0, part.y0, part.width(), part.height());
}

// Of a pixel at the scissor's rim llvmpipe does not draw every sample. What is drawn anew where a pixel has
// several is drawn one pixel further, where it changes nothing.
constexpr int kScissorRim = 1;

// Draws each of the parts, with the scissor around it.
template <class Draw>
void drawParts(const GlApi& gl, const std::vector<PixelBox>& parts, Draw&& draw) {
    for (const PixelBox& part : parts) {
        setScissor(gl, part);
        draw();
    }
}

// Copies colour or depth, or both, of those parts from one framebuffer to the other, whatever the scissor:
// several samples of a pixel to as many, or to one.
inline void copyParts(const GlApi& gl, GLuint from, GLuint to, const std::vector<PixelBox>& parts,
                      GLbitfield what) {
    gl.BindFramebuffer(GL_READ_FRAMEBUFFER, from);
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, to);
    gl.Disable(GL_SCISSOR_TEST);
    for (const PixelBox& part : parts)
        gl.BlitFramebuffer(part.x0, part.y0, part.x1, part.y1, part.x0, part.y0, part.x1, part.y1, what,
                           GL_NEAREST);
    gl.Enable(GL_SCISSOR_TEST);
}

}  // namespace bonemill
