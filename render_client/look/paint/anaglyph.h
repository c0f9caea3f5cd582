// Puts two eyes' pictures into one for red-cyan glasses.
//
// It belongs to the thread of the context.
#pragma once

#include <memory>

#include "render_client/look/gl/gl_object.h"
#include "render_client/look/gl/program.h"

namespace bonemill {

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
