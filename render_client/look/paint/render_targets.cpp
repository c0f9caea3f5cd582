#include "render_client/look/paint/render_targets.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bonemill {
namespace {

constexpr double kLoosest = 2;        // a range that is N times too wide is made anew
constexpr double kRangeMargin = 0.1;  // of the near and far distance: room for the tool to move

bool isSame(const Camera& a, const Camera& b) {
    return a.eye_W == b.eye_W && a.R_WC == b.R_WC && a.field_of_view == b.field_of_view &&
           a.focus == b.focus && a.shift == b.shift;
}

template <class Matrix>
void append(std::vector<float>& signature, const Matrix& matrix) {
    signature.insert(signature.end(), matrix.data(), matrix.data() + matrix.size());
}

std::vector<float> signatureOf(const Frame& frame, int width, int height) {
    std::vector<float> signature{float(width),       float(height), frame.bone_radius, frame.key.reach,
                                 frame.field_radius, frame.focus,   frame.blur_per_m};
    append(signature, frame.clip_from_camera);
    append(signature, frame.X_CV);
    append(signature, frame.key.direction);
    for (const Eigen::Vector4f& plane : frame.cuts_V.planes) append(signature, plane);
    append(signature, frame.bone_V.min());
    append(signature, frame.bone_V.max());
    return signature;
}

}  // namespace

DepthRange PictureChanges::range(const Camera& camera, const DepthRange& needed) {
    const bool is_tight = needed.far * kLoosest > range_.far && needed.near < range_.near * kLoosest;
    if (isSame(camera, camera_) && is_tight) {
        range_ = {std::min(range_.near, needed.near), std::max(range_.far, needed.far)};
    } else {
        range_ = {needed.near * (1 - kRangeMargin), needed.far * (1 + kRangeMargin)};
        camera_ = camera;
    }
    return range_;
}

PictureChanges::Dirty PictureChanges::next(const Frame& frame, int width, int height,
                                           const Eigen::AlignedBox3f& changed_V, const PixelBox& moving,
                                           std::vector<float> still_like) {
    const bool stands_still = !still_like.empty() && still_like == still_like_;
    still_like_ = std::move(still_like);
    const PixelBox moved = std::exchange(moving_, moving);
    const PixelBox whole = PixelBox::whole(width, height);
    std::vector<float> signature = signatureOf(frame, width, height);
    if (signature != signature_) {
        signature_ = std::move(signature);
        return {whole, whole};
    }
    const PixelBox bone = PixelBox::around(changed_V, frame.clip_from_camera * frame.X_CV, width, height);
    if (stands_still) return {bone, bone};
    return {bone, bone.joined(moved).joined(moving)};
}

PixelBox PixelBox::joined(const PixelBox& other) const {
    if (isEmpty()) return other;
    if (other.isEmpty()) return *this;
    return {std::min(x0, other.x0), std::min(y0, other.y0), std::max(x1, other.x1), std::max(y1, other.y1)};
}

PixelBox PixelBox::within(const PixelBox& other) const {
    return {std::max(x0, other.x0), std::max(y0, other.y0), std::min(x1, other.x1), std::min(y1, other.y1)};
}

PixelBox PixelBox::around(const Eigen::AlignedBox3f& box, const Eigen::Matrix4f& clip_from_model, int width,
                          int height) {
    if (box.isEmpty()) return {};
    Eigen::AlignedBox2f ndc;
    for (int i = 0; i < 8; ++i) {
        const Eigen::Vector4f corner =
            clip_from_model * box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(i)).homogeneous();
        if (!(corner.w() > 0) || !(corner.z() >= -corner.w()) || !corner.allFinite())
            return whole(width, height);
        ndc.extend(Eigen::Vector2f(corner.head<2>() / corner.w()));
    }
    const auto pixel = [](float value, int size) {
        return std::clamp((value + 1) / 2 * float(size), -1.0f, float(size) + 1);
    };
    constexpr int kRounding = 1;  // rasterisation may round either way
    const PixelBox touched{
        int(std::floor(pixel(ndc.min().x(), width))), int(std::floor(pixel(ndc.min().y(), height))),
        int(std::ceil(pixel(ndc.max().x(), width))), int(std::ceil(pixel(ndc.max().y(), height)))};
    return touched.grown(kRounding).within(whole(width, height));
}

Eigen::Matrix4f PixelBox::zoom(int picture_width, int picture_height) const {
    const float scale_x = float(picture_width) / float(width()),
                scale_y = float(picture_height) / float(height());
    const float middle_x = float(x0 + x1) / float(picture_width) - 1;
    const float middle_y = float(y0 + y1) / float(picture_height) - 1;
    Eigen::Matrix4f zoom = Eigen::Matrix4f::Identity();
    zoom(0, 0) = scale_x;
    zoom(1, 1) = scale_y;
    zoom(0, 3) = -middle_x * scale_x;
    zoom(1, 3) = -middle_y * scale_y;
    return zoom;
}

RenderTargets::RenderTargets(const GlApi& gl, int width, int height, Quality quality)
    : gl_(gl),
      width_(width),
      height_(height),
      quality_(quality),
      scene_(gl),
      scene_surface_(gl),
      resolved_(gl),
      occlusion_(gl),
      shadow_(gl),
      bone_(gl),
      bone_surface_(gl),
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

    maps_.emplace(gl_, width_, height_, samples);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, scene_surface_.name());
    gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER,
                                scene_depth_.name());
    maps_->attach();
    checkComplete("scene's surface");
}

void RenderTargets::makeKept() {
    makeLayer(bone_, bone_colour_, bone_depth_, "bone");
    maps_.emplace(gl_, width_, height_, 0);
    makeSurface(bone_surface_, bone_depth_, "bone's surface");
    makeSurface(scene_surface_, depth_texture_, "scene's surface");
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
    gl_.setSampling(GL_TEXTURE_2D, filter);
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
