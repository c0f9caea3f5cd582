// These own OpenGL names. A name is deleted with its object, which therefore must die before its context and
// on its thread.
#pragma once

#include <utility>

#include "render_client/look/gl/gl_api.h"

namespace bonemill {

using GenFunction = void(APIENTRY*)(GLsizei, GLuint*);
using DeleteFunction = void(APIENTRY*)(GLsizei, const GLuint*);

// The GlApi must outlive the object.
template <GenFunction GlApi::*Gen, DeleteFunction GlApi::*Delete>
class GlObject {
  public:
    explicit GlObject(const GlApi& gl) : gl_(&gl) { (gl.*Gen)(1, &name_); }
    GlObject(GlObject&& other) noexcept : gl_(other.gl_), name_(std::exchange(other.name_, 0)) {}
    GlObject& operator=(GlObject&& other) noexcept {
        std::swap(gl_, other.gl_);
        std::swap(name_, other.name_);
        return *this;
    }
    GlObject(const GlObject&) = delete;
    GlObject& operator=(const GlObject&) = delete;
    ~GlObject() {
        if (name_) (gl_->*Delete)(1, &name_);
    }
    GLuint name() const noexcept { return name_; }

  private:
    const GlApi* gl_;
    GLuint name_ = 0;
};

using GlBuffer = GlObject<&GlApi::GenBuffers, &GlApi::DeleteBuffers>;
using GlVertexArray = GlObject<&GlApi::GenVertexArrays, &GlApi::DeleteVertexArrays>;
using GlTexture = GlObject<&GlApi::GenTextures, &GlApi::DeleteTextures>;
using GlFramebuffer = GlObject<&GlApi::GenFramebuffers, &GlApi::DeleteFramebuffers>;
using GlRenderbuffer = GlObject<&GlApi::GenRenderbuffers, &GlApi::DeleteRenderbuffers>;

}  // namespace bonemill
