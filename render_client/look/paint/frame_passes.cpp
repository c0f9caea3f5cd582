#include "render_client/look/paint/frame_passes.h"

#include <cmath>
#include <string>

#include "render_client/look/shaders/shaders.h"

namespace bonemill {
namespace {

constexpr double kOcclusionRadius = 0.10;   // of the bone's radius
constexpr float kOcclusionPicture = 0.06f;  // the radius is at most this part of the picture's height
constexpr float kMaxBlur = 0.015f;          // of the picture's height
constexpr int kFilterReach = 8;             // pixels that the composite's filter looks beyond

static_assert(kMaxBlur < kOcclusionPicture, "or the blur would reach further than reach() says");

std::string finishedVertex() {
    return std::string("#define UPSIDE_DOWN\n") + shaders::kFullScreenVertex;
}

}  // namespace

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
    gl_.setSampling(GL_TEXTURE_2D, GL_NEAREST, GL_REPEAT);
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

FramePasses::FramePasses(const GlApi& gl)
    : gl_(gl),
      background_(gl, "background", shaders::kFullScreenVertex, shaders::kBackgroundFragment),
      occlusion_(gl, "occlusion", shaders::kFullScreenVertex, shaders::kOcclusionFragment),
      composite_(gl, "composite", finishedVertex(), shaders::kCompositeFragment),
      instrument_(gl, "composite of an instrument", finishedVertex(),
                  std::string("#define INSTRUMENT\n") + shaders::kCompositeFragment),
      tool_shadow_(gl, "shadow of the tool", finishedVertex(), shaders::kToolShadowFragment),
      no_attributes_(gl) {}

int FramePasses::reach(int height) {
    return int(std::ceil(kOcclusionPicture * float(height))) + kFilterReach;
}

int FramePasses::blurReach(const Frame& frame, int height) {
    return frame.blur_per_m > 0 ? int(std::ceil(kMaxBlur * float(height))) + 1 : 0;
}

void FramePasses::drawBackground(const Parts& parts) const {
    gl_.Disable(GL_DEPTH_TEST);
    background_.use();
    drawParts(gl_, parts, [&] { drawFullScreen(); });
    gl_.Enable(GL_DEPTH_TEST);
}

void FramePasses::drawOcclusion(const Frame& frame, const RenderTargets& targets, GLuint depth_texture,
                                const Parts& parts) const {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, targets.occlusion());
    gl_.Viewport(0, 0, targets.occlusionWidth(), targets.occlusionHeight());
    gl_.Disable(GL_DEPTH_TEST);
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindTexture(GL_TEXTURE_2D, depth_texture);
    occlusion_.use();
    occlusion_.set("depth_map", 0);
    occlusion_.set("near_far", frame.near_far);
    occlusion_.set("tangents", frame.tangents);
    occlusion_.set("shift", frame.shift);
    occlusion_.set("radius", float(kOcclusionRadius) * frame.bone_radius);
    occlusion_.set("max_radius", kOcclusionPicture);
    for (const PixelBox& part : parts) {
        setScissor(gl_,
                   {part.x0 / 2 - 1, part.y0 / 2 - 1, part.x1 / 2 + 2, part.y1 / 2 + 2});  // half the size
        drawFullScreen();
    }
    gl_.Viewport(0, 0, targets.width(), targets.height());
}

void FramePasses::compose(const Frame& frame, const RenderTargets& targets, const Parts& parts) const {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, targets.finished());
    gl_.Viewport(0, 0, targets.width(), targets.height());
    gl_.Disable(GL_DEPTH_TEST);
    const GLuint textures[] = {targets.colourTexture(), targets.depthTexture(), targets.occlusionTexture()};
    for (GLenum unit = 0; unit < 3; ++unit) {
        gl_.ActiveTexture(GL_TEXTURE0 + unit);
        gl_.BindTexture(GL_TEXTURE_2D, textures[unit]);
    }
    const bool is_plain = frame.field_radius <= 0 && frame.blur_per_m <= 0;
    const Program& composite = is_plain ? composite_ : instrument_;
    composite.use();
    composite.set("colour_map", 0);
    composite.set("depth_map", 1);
    composite.set("occlusion_map", 2);
    composite.set("near_far", frame.near_far);
    composite.set("depth_tolerance", 0.5f * float(kOcclusionRadius) * frame.bone_radius);
    if (!is_plain) {
        composite.set("field_radius", frame.field_radius);
        composite.set("focus", frame.focus);
        composite.set("blur_per_m", frame.blur_per_m);
        composite.set("most_blur", kMaxBlur);
    }
    drawFinished(targets, parts);
    gl_.ActiveTexture(GL_TEXTURE0);
}

void FramePasses::drawToolShadow(const Frame& frame, const RenderTargets& targets, const Parts& parts) const {
    const ToolShadow& shadow = *frame.tool_shadow;
    gl_.BindFramebuffer(GL_FRAMEBUFFER, targets.finished());
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindTexture(GL_TEXTURE_2D, targets.depthTexture());
    tool_shadow_.use();
    tool_shadow_.set("depth_map", 0);
    tool_shadow_.set("near_far", frame.near_far);
    tool_shadow_.set("tangents", frame.tangents);
    tool_shadow_.set("shift", frame.shift);
    tool_shadow_.set("key_direction", frame.key.direction);
    tool_shadow_.set("burr", shadow.burr);
    tool_shadow_.set("shaft", shadow.shaft);
    tool_shadow_.set("radii", Eigen::Vector2f(shadow.burr_radius, shadow.shaft_radius));
    tool_shadow_.set("reach", shadow.reach);
    gl_.Enable(GL_BLEND);
    gl_.BlendFunc(GL_DST_COLOR, GL_ZERO);
    drawFinished(targets, parts);
    gl_.Disable(GL_BLEND);
}

void FramePasses::drawFinished(const RenderTargets& targets, const Parts& parts) const {
    for (const PixelBox& part : parts) {
        setScissor(gl_, part.upsideDown(targets.height()));
        drawFullScreen();
    }
}

void FramePasses::drawFullScreen() const {
    gl_.BindVertexArray(no_attributes_.name());
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
    gl_.BindVertexArray(0);
}

}  // namespace bonemill
