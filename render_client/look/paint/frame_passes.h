// Draws what goes over the whole frame: the background before bone and tool, ambient occlusion and the
// composite after them.
//
// It belongs to the thread of the context.
#pragma once

#include "render_client/look/gl/gl_object.h"
#include "render_client/look/gl/program.h"
#include "render_client/look/paint/frame.h"
#include "render_client/look/paint/render_targets.h"

namespace bonemill {

class FramePasses {
  public:
    // Throws GlError with the compiler's log when the driver refuses a shader.
    explicit FramePasses(const GlApi& gl);

    // Fills the bound framebuffer; leaves the depth test on.
    void drawBackground() const;
    // Makes the half-size occlusion from the resolved depth.
    void drawOcclusion(const Frame& frame, const RenderTargets& targets) const;
    // Puts the finished picture (without figures) into `target`, from column x on.
    void compose(const Frame& frame, const RenderTargets& targets, int x, GLuint target) const;

    // Darkens what lies in the shadow of a frame's tool_shadow in the finished picture in `target`, a
    // framebuffer of its size without depth.
    void drawToolShadow(const Frame& frame, const RenderTargets& targets, GLuint target) const;

    // Returns how many pixels beyond a changed one these passes may look different, in a
    // picture of this height.
    static int reach(int height);

  private:
    void drawFullScreen() const;

    const GlApi& gl_;
    Program background_, occlusion_, composite_, instrument_, tool_shadow_;
    GlVertexArray no_attributes_;
};

}  // namespace bonemill
