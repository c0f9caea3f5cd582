#include "render_client/look/paint/render_targets.h"

#include <algorithm>

namespace bonemill {

RenderTargets::RenderTargets(const GlApi& gl, int width, int height, Quality quality)
    : gl_(gl),
      width_(width),
      height_(height),
      quality_(quality),
      scene_(gl),
      resolved_(gl),
      occlusion_(gl),
      shadow_(gl),
      bone_(gl),
      finished_(gl),
      scene_colour_(gl),
      scene_depth_(gl),
      colour_texture_(gl),
      depth_texture_(gl),
      occlusion_texture_(gl),
      shadow_texture_(gl),
      bone_colour_(gl),
      bone_depth_(gl),
      finished_colour_(gl) {
    makeResolved();
    quality == Quality::kFull ? makeScene() : makeKept();
    makeOcclusion();
    makeShadow();
    gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl_.check("making the render targets");
}

void RenderTargets::makeScene() {
    GLint most_samples = 0;
    gl_.GetIntegerv(GL_MAX_SAMPLES, &most_samples);
    const GLsizei samples = std::min(most_samples, kWantedSamples);
    gl_.BindRenderbuffer(GL_RENDERBUFFER, scene_colour_.name());
    gl_.RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_RGBA8, width_, height_);
    gl_.BindRenderbuffer(GL_RENDERBUFFER, scene_depth_.name());
    gl_.RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH24_STENCIL8, width_, height_);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, scene_.name());
    gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, scene_colour_.name());
    gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER,
                                scene_depth_.name());
    checkComplete("scene");
}

void RenderTargets::makeKept() {
    makeLayer(bone_, bone_colour_, bone_depth_, "bone");
    makeTexture(finished_colour_, GL_RGBA8, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, GL_NEAREST);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, finished_.name());
    gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, finished_colour_.name(), 0);
    checkComplete("finished picture");
}

void RenderTargets::makeResolved() {
    makeLayer(resolved_, colour_texture_, depth_texture_, "resolved scene");
}

// Makes colour and depth of the picture's size. A depth buffer is resolved only into one of the same format.
void RenderTargets::makeLayer(const GlFramebuffer& layer, const GlTexture& colour, const GlTexture& depth,
                              const char* what) const {
    makeTexture(colour, GL_RGBA8, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, GL_NEAREST);
    makeTexture(depth, GL_DEPTH24_STENCIL8, width_, height_, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8,
                GL_NEAREST);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, layer.name());
    gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour.name(), 0);
    gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_TEXTURE_2D, depth.name(), 0);
    checkComplete(what);
}

void RenderTargets::makeOcclusion() {
    makeTexture(occlusion_texture_, GL_RG16F, occlusionWidth(), occlusionHeight(), GL_RG, GL_FLOAT,
                GL_NEAREST);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, occlusion_.name());
    gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, occlusion_texture_.name(),
                             0);
    checkComplete("occlusion");
}

// The sampler wants a texture in quick quality too.
void RenderTargets::makeShadow() {
    const int size = quality_ == Quality::kFull ? kShadowSize : 1;
    makeTexture(shadow_texture_, GL_DEPTH_COMPONENT24, size, size, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT,
                GL_LINEAR);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, shadow_.name());
    gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, shadow_texture_.name(), 0);
    gl_.DrawBuffer(GL_NONE);
    gl_.ReadBuffer(GL_NONE);
    checkComplete("shadow");
}

void RenderTargets::makeTexture(const GlTexture& texture, GLint format, int width, int height, GLenum layout,
                                GLenum type, GLint filter) const {
    gl_.BindTexture(GL_TEXTURE_2D, texture.name());
    gl_.TexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, layout, type, nullptr);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void RenderTargets::copy(GLuint from, GLuint to, const PixelBox& part, GLbitfield what) const {
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, from);
    gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, to);
    gl_.BlitFramebuffer(part.x0, part.y0, part.x1, part.y1, part.x0, part.y0, part.x1, part.y1, what,
                        GL_NEAREST);
}

void RenderTargets::resolve() const {
    if (quality_ == Quality::kQuick) return;  // drawn there
    copy(scene_.name(), resolved_.name(), PixelBox::whole(width_, height_),
         GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

std::optional<float> RenderTargets::depthAt(int x, int y) const {
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return std::nullopt;
    float depth = 1;
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, resolved_.name());
    gl_.ReadPixels(x, height_ - 1 - y, 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT, &depth);
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    if (depth >= 1) return std::nullopt;
    return depth;
}

void RenderTargets::checkComplete(const char* what) const {
    const GLenum status = gl_.CheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status == GL_FRAMEBUFFER_COMPLETE) return;
    throw GlError(std::string("the driver refuses the ") + what + " buffer of " + std::to_string(width_) +
                  "x" + std::to_string(height_) + " pixels (status " + std::to_string(status) + ")");
}

}  // namespace bonemill
