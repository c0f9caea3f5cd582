#include "render_client/look/paint/shadow_map.h"

#include <algorithm>
#include <utility>

#include "render_client/look/paint/picture_parts.h"
#include "render_client/look/shaders/shaders.h"

namespace bonemill {
namespace {

constexpr GLenum kEyePlane = 3;  // number of the clip plane after those of the cuts
constexpr int kCasterSlices = 8;
// Texels beside a caster's that a surface looks at: keyVisibility() goes up to 4 texels along the normal,
// and 1.3 aside, and reads between two.
constexpr int kLooksAside = 8;

std::vector<float> standOf(const Frame& frame, const ToolMesh& tool) {
    std::vector<float> numbers{float(tool.revision()), float(frame.X_CT.has_value())};
    if (frame.X_CT) numbers.insert(numbers.end(), frame.X_CT->data(), frame.X_CT->data() + 16);
    return numbers;
}

}  // namespace

ShadowMap::ShadowMap(const GlApi& gl, int size)
    : gl_(gl),
      size_(size),
      program_(gl, "shadow", shaders::kShadowVertex, shaders::kDepthFragment),
      bone_framebuffer_(gl),
      framebuffer_(gl),
      bone_texture_(gl),
      texture_(gl) {
    makeMap(bone_framebuffer_, bone_texture_);
    makeMap(framebuffer_, texture_);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
}

void ShadowMap::makeMap(const GlFramebuffer& framebuffer, const GlTexture& texture) const {
    gl_.BindTexture(GL_TEXTURE_2D, texture.name());
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, size_, size_, 0, GL_DEPTH_COMPONENT,
                   GL_UNSIGNED_INT, nullptr);
    gl_.setSampling(GL_TEXTURE_2D, GL_LINEAR);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture.name(), 0);
    gl_.DrawBuffer(GL_NONE);
    gl_.ReadBuffer(GL_NONE);
    if (gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw GlError("the driver refuses a shadow map of " + std::to_string(size_) + " texels a side");
}

void ShadowMap::draw(const Frame& frame, const NodeStore& nodes, const ToolMesh& tool, bool has_bone) {
    const PixelBox whole = PixelBox::whole(size_, size_);
    if (has_bone) {
        drawBone(frame, nodes, whole);
    } else {
        begin(bone_framebuffer_.name(), whole);
        gl_.Clear(GL_DEPTH_BUFFER_BIT);
    }
    copyParts(gl_, bone_framebuffer_.name(), framebuffer_.name(), {whole}, GL_DEPTH_BUFFER_BIT);
    drawTool(frame, tool);
    tool_ = toolIn(frame, tool);
    tool_like_ = standOf(frame, tool);
}

std::vector<Eigen::AlignedBox3f> ShadowMap::update(const Frame& frame, const NodeStore& nodes,
                                                   const ToolMesh& tool,
                                                   const Eigen::AlignedBox3f& changed_V) {
    std::vector<Caster> changed;
    const Caster bone = casterOf(changed_V, frame.key.shadow_from_camera * frame.X_CV);
    if (!bone.texels.isEmpty()) changed.push_back(bone);
    std::vector<float> stand = standOf(frame, tool);
    if (std::exchange(tool_like_, stand) != stand) {
        changed.insert(changed.end(), tool_.begin(), tool_.end());
        tool_ = toolIn(frame, tool);
        changed.insert(changed.end(), tool_.begin(), tool_.end());
    }
    if (changed.empty()) return {};
    if (!bone.texels.isEmpty()) drawBone(frame, nodes, bone.texels);
    PixelTiles copied(size_, size_);
    for (const Caster& caster : changed) copied.add(caster.texels);
    copyParts(gl_, bone_framebuffer_.name(), framebuffer_.name(), copied.boxes(), GL_DEPTH_BUFFER_BIT);
    drawTool(frame, tool);
    std::vector<Eigen::AlignedBox3f> shadowed;
    for (const Caster& caster : changed)
        if (!caster.texels.isEmpty()) shadowed.push_back(shadowedBy(caster, frame));
    return shadowed;
}

void ShadowMap::begin(GLuint framebuffer, const PixelBox& part) const {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl_.Viewport(0, 0, size_, size_);
    setScissor(gl_, part);
    gl_.Enable(GL_DEPTH_TEST);
    gl_.DepthFunc(GL_LESS);
    gl_.DepthMask(GL_TRUE);
}

void ShadowMap::aim(const Frame& frame, const Eigen::Matrix4f& camera_from_model) const {
    program_.set("clip_from_model", Eigen::Matrix4f(frame.key.shadow_from_camera * camera_from_model));
    program_.set("eye_plane", Eigen::Vector4f(-camera_from_model.row(2).transpose()));
}

void ShadowMap::drawBone(const Frame& frame, const NodeStore& nodes, const PixelBox& part) const {
    begin(bone_framebuffer_.name(), part);
    gl_.Clear(GL_DEPTH_BUFFER_BIT);
    const ClipPlanes clip(gl_, frame.cuts_V);
    if (frame.key.is_at_eye) gl_.Enable(GL_CLIP_DISTANCE0 + kEyePlane);
    program_.use();
    setCutPlanes(program_, frame.cuts_V);
    aim(frame, frame.X_CV);
    nodes.draw(program_, part.zoom(size_, size_) * frame.key.shadow_from_camera * frame.X_CV);
    gl_.Disable(GL_CLIP_DISTANCE0 + kEyePlane);
}

// Where the map still has it, it is drawn once more, which changes nothing.
void ShadowMap::drawTool(const Frame& frame, const ToolMesh& tool) const {
    if (!frame.X_CT) return;
    begin(framebuffer_.name(), PixelBox::whole(size_, size_));
    if (frame.key.is_at_eye) gl_.Enable(GL_CLIP_DISTANCE0 + kEyePlane);
    program_.use();
    aim(frame, *frame.X_CT);
    program_.set("origin", Eigen::Vector3f(Eigen::Vector3f::Zero()));
    program_.set("step", Eigen::Vector3f(Eigen::Vector3f::Ones()));
    tool.draw();
    gl_.Disable(GL_CLIP_DISTANCE0 + kEyePlane);
}

std::vector<ShadowMap::Caster> ShadowMap::toolIn(const Frame& frame, const ToolMesh& tool) const {
    std::vector<Caster> slices;
    if (!frame.X_CT) return slices;
    for (const Eigen::AlignedBox3f& slice : sliced(tool.box(), kCasterSlices))
        slices.push_back(casterOf(slice, frame.key.shadow_from_camera * *frame.X_CT));
    return slices;
}

// The light's rays are parallel.
ShadowMap::Caster ShadowMap::casterOf(const Eigen::AlignedBox3f& box,
                                      const Eigen::Matrix4f& shadow_from_model) const {
    Caster caster{PixelBox::around(box, shadow_from_model, size_, size_), 1};
    for (int i = 0; i < 8 && !box.isEmpty(); ++i) {
        const auto corner = box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(i));
        caster.nearest = std::min(caster.nearest, shadow_from_model.row(2).dot(corner.homogeneous()));
    }
    return caster;
}

Eigen::AlignedBox3f ShadowMap::shadowedBy(const Caster& caster, const Frame& frame) const {
    const PixelBox texels = caster.texels.grown(kLooksAside);
    const auto clip = [&](int texel) { return 2 * float(texel) / float(size_) - 1; };
    const float aside = float(kLooksAside) * frame.key.shadow_texel;  // m
    const float before = aside * frame.key.shadow_from_camera.row(2).head<3>().norm();
    return {Eigen::Vector3f(clip(texels.x0), clip(texels.y0), std::min(caster.nearest - before, 1.0f)),
            Eigen::Vector3f(clip(texels.x1), clip(texels.y1), 1)};
}

}  // namespace bonemill
