// Draws what goes over the whole frame: the background before bone and tool, ambient occlusion and the
// composite after them, the eyes of an anaglyph.
//
// It belongs to the thread of the context.
#pragma once

#include <memory>
#include <vector>

#include "render_client/look/gl/gl_api.h"
#include "render_client/look/paint/frame.h"
#include "render_client/look/paint/picture_parts.h"
#include "render_client/look/paint/render_targets.h"

namespace bonemill {

class FramePasses {
  public:
    // Throws GlError with the compiler's log when the driver refuses a shader.
    explicit FramePasses(const GlApi& gl);

    // They draw those parts of the picture, and want the scissor test enabled.
    using Parts = std::vector<PixelBox>;
    // Fills the bound framebuffer; leaves the depth test on.
    void drawBackground(const Parts& parts) const;
    // Makes the half-size occlusion from this depth texture of the targets. Leaves the viewport that of the
    // picture.
    void drawOcclusion(const Frame& frame, const RenderTargets& targets, GLuint depth_texture,
                       const Parts& parts) const;
    // Makes the finished picture (without figures).
    void compose(const Frame& frame, const RenderTargets& targets, const Parts& parts) const;

    // Darkens what lies in the shadow of a frame's tool_shadow in the finished picture.
    void drawToolShadow(const Frame& frame, const RenderTargets& targets, const Parts& parts) const;

    // Return how many pixels beyond a changed one the picture may look different, in a picture of this
    // height: where the occlusion changes with it, and where it does not.
    static int reach(int height);
    static int blurReach(const Frame& frame, int height);

  private:
    void drawFullScreen() const;
    void drawFinished(const RenderTargets& targets, const Parts& parts) const;

    const GlApi& gl_;
    Program background_, occlusion_, composite_, instrument_, tool_shadow_;
    GlVertexArray no_attributes_;
};

// Puts two eyes' pictures into one for red-cyan glasses.
class Anaglyph {
  public:
    explicit Anaglyph(const GlApi& gl);

    // Makes room for pictures of this size (pixels).
    void resize(int width, int height);

    // The eyes are drawn into left() and right(); then combine() puts them together into `target`.
    GLuint left() const { return eyes_->left.framebuffer.name(); }
    GLuint right() const { return eyes_->right.framebuffer.name(); }
    void combine(GLuint target) const;

  private:
    struct Eye {
        explicit Eye(const GlApi& gl) : framebuffer(gl), texture(gl) {}
        GlFramebuffer framebuffer;
        GlTexture texture;
    };
    struct Eyes {
        explicit Eyes(const GlApi& gl) : left(gl), right(gl) {}
        Eye left, right;
    };
    void makeEye(const Eye& eye) const;

    const GlApi& gl_;
    Program program_;
    GlVertexArray no_attributes_;
    std::unique_ptr<Eyes> eyes_;
    int width_ = 0;
    int height_ = 0;
};

}  // namespace bonemill
