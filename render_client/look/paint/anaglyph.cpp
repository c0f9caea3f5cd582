#include "render_client/look/paint/anaglyph.h"

#include <string>

#include "render_client/look/shaders/shaders.h"

namespace bonemill {

Anaglyph::Anaglyph(const GlApi& gl)
    : gl_(gl),
      program_(gl, "anaglyph", shaders::kFullScreenVertex, shaders::kAnaglyphFragment),
      no_attributes_(gl) {}

void Anaglyph::resize(int width, int height) {
    if (eyes_ && width == width_ && height == height_) return;
    width_ = width;
    height_ = height;
    eyes_ = std::make_unique<Eyes>(gl_);
    makeEye(eyes_->left);
    makeEye(eyes_->right);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
}

void Anaglyph::makeEye(const Eye& eye) const {
    gl_.BindTexture(GL_TEXTURE_2D, eye.texture.name());
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width_, height_, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, eye.framebuffer.name());
    gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, eye.texture.name(), 0);
    if (gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw GlError("the driver refuses an eye's picture of " + std::to_string(width_) + "x" +
                      std::to_string(height_) + " pixels");
}

void Anaglyph::combine(GLuint target) const {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target);
    gl_.Viewport(0, 0, width_, height_);
    gl_.Disable(GL_DEPTH_TEST);
    program_.use();
    const GLuint textures[] = {eyes_->left.texture.name(), eyes_->right.texture.name()};
    for (GLenum unit = 0; unit < 2; ++unit) {
        gl_.ActiveTexture(GL_TEXTURE0 + unit);
        gl_.BindTexture(GL_TEXTURE_2D, textures[unit]);
    }
    program_.set("left_eye", 0);
    program_.set("right_eye", 1);
    gl_.BindVertexArray(no_attributes_.name());
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
    gl_.BindVertexArray(0);
    gl_.ActiveTexture(GL_TEXTURE0);
}

}  // namespace bonemill
