#include "render_client/look/paint/render_targets.h"

#include <algorithm>

#include "render_client/look/paint/picture_parts.h"

namespace bonemill {

RenderTargets::RenderTargets(const GlApi& gl, int width, int height, Quality quality)
    : gl_(gl),
      width_(width),
      height_(height),
      quality_(quality),
      scene_(gl),
      scene_surface_(gl),
      resolved_(gl),
      occlusion_(gl),
      bone_(gl),
      bone_surface_(gl),
      finished_(gl),
      scene_colour_(gl),
      scene_depth_(gl),
      sampled_bone_colour_(gl),
      sampled_bone_depth_(gl),
      colour_texture_(gl),
      depth_texture_(gl),
      occlusion_texture_(gl),
      bone_colour_(gl),
      bone_depth_(gl),
      finished_colour_(gl) {
    makeResolved();
    quality == Quality::kFull ? makeSampled() : makePlain();
    makeOcclusion();
    makeFinished();
    gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl_.check("making the render targets");
}

void RenderTargets::makeSampled() {
    GLint most_samples = 0;
    gl_.GetIntegerv(GL_MAX_SAMPLES, &most_samples);
    const GLsizei samples = std::min(most_samples, kWantedSamples);
    makeSampledLayer(scene_, scene_colour_, scene_depth_, samples, "scene");
    makeSampledLayer(bone_, sampled_bone_colour_, sampled_bone_depth_, samples, "bone");
    maps_.emplace(gl_, width_, height_, samples);
    makeSampledSurface(scene_surface_, scene_depth_, "scene's surface");
    makeSampledSurface(bone_surface_, sampled_bone_depth_, "bone's surface");
}

void RenderTargets::makeSampledLayer(const GlFramebuffer& layer, const GlRenderbuffer& colour,
                                     const GlRenderbuffer& depth, GLsizei samples, const char* what) const {
    gl_.BindRenderbuffer(GL_RENDERBUFFER, colour.name());
    gl_.RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_RGBA8, width_, height_);
    gl_.BindRenderbuffer(GL_RENDERBUFFER, depth.name());
    gl_.RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH24_STENCIL8, width_, height_);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, layer.name());
    gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour.name());
    gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, depth.name());
    checkComplete(what);
}

void RenderTargets::makeSampledSurface(const GlFramebuffer& surface, const GlRenderbuffer& depth,
                                       const char* what) const {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, surface.name());
    gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, depth.name());
    maps_->attach();
    checkComplete(what);
}

void RenderTargets::makePlain() {
    makeLayer(bone_, bone_colour_, bone_depth_, "bone");
    maps_.emplace(gl_, width_, height_, 0);
    makeSurface(bone_surface_, bone_depth_, "bone's surface");
    makeSurface(scene_surface_, depth_texture_, "scene's surface");
}

void RenderTargets::makeFinished() {
    makeTexture(finished_colour_, GL_RGBA8, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, GL_NEAREST);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, finished_.name());
    gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, finished_colour_.name(), 0);
    checkComplete("finished picture");
}

// What the maps take there is tested against this depth.
void RenderTargets::makeSurface(const GlFramebuffer& surface, const GlTexture& depth,
                                const char* what) const {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, surface.name());
    gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_TEXTURE_2D, depth.name(), 0);
    maps_->attach();
    checkComplete(what);
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

void RenderTargets::makeTexture(const GlTexture& texture, GLint format, int width, int height, GLenum layout,
                                GLenum type, GLint filter) const {
    gl_.BindTexture(GL_TEXTURE_2D, texture.name());
    gl_.TexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, layout, type, nullptr);
    gl_.setSampling(GL_TEXTURE_2D, filter);
}

void RenderTargets::resolve(const std::vector<PixelBox>& parts) const {
    if (quality_ == Quality::kQuick) return;  // drawn there
    copyParts(gl_, scene_.name(), resolved_.name(), parts, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
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
