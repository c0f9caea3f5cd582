#include "render_client/scene/scene_renderer.h"

#include <algorithm>
#include <cmath>

#include "render_client/scene/shaders.h"

namespace bonemill {
namespace {

constexpr double kGhostDistance = 1.5e-4;  // m
constexpr double kGhostAngle = 0.03;       // rad
constexpr double kShownBeyondView =
    2.0;  // half picture diagonals at the target that the shadow map covers when one is close
constexpr double kOcclusionRadius = 0.10;   // of the bone's radius
constexpr float kOcclusionPicture = 0.06f;  // at most this part of the picture's height
constexpr double kGrain = 0.045;            // size of the mottling over the bone's radius

Eigen::Matrix4f matrixOf(const Pose& X_AB) {
    Eigen::Matrix4f matrix = Eigen::Matrix4f::Identity();
    matrix.topLeftCorner<3, 3>() = X_AB.rotation.toRotationMatrix().cast<float>();
    matrix.topRightCorner<3, 1>() = X_AB.position.cast<float>();
    return matrix;
}

struct Sphere {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    double radius = 0;
};

Sphere around(const Eigen::AlignedBox3d& box) {
    if (box.isEmpty()) return {};
    return {box.center(), box.diagonal().norm() / 2};
}

template <class Box>
void extendBy(Eigen::AlignedBox3d& box_W, const Pose& X_WA, const Box& box_A) {
    if (box_A.isEmpty()) return;
    for (int i = 0; i < 8; ++i) {
        box_W.extend(X_WA * box_A.corner(static_cast<typename Box::CornerType>(i)).template cast<double>());
    }
}

struct KeyLight {
    Eigen::Vector3f direction;           // C, towards the light
    Eigen::Matrix4f shadow_from_camera;  // to the shadow map's -1 .. 1
    float shadow_texel;                  // m
};

// From the upper left of the camera; its shadow map covers the sphere.
KeyLight aimKeyLight(const OrbitCamera& camera, const Sphere& lit_W) {
    const Eigen::Vector3d key_C = Eigen::Vector3d(-0.55, 0.70, 0.62).normalized();
    const double half_size = std::max(lit_W.radius, 1e-4);
    Eigen::Matrix3d R_LC;
    R_LC.row(2) = -key_C;  // depth grows away from the light
    R_LC.row(0) = Eigen::Vector3d::UnitY().cross(key_C).normalized();
    R_LC.row(1) = key_C.cross(Eigen::Vector3d(R_LC.row(0)));
    const Eigen::Vector3d center_C = camera.R_WC().transpose() * (lit_W.center - camera.eye());
    Eigen::Matrix4d shadow_from_camera = Eigen::Matrix4d::Identity();
    shadow_from_camera.topLeftCorner<3, 3>() = R_LC / half_size;
    shadow_from_camera.topRightCorner<3, 1>() = -(R_LC * center_C) / half_size;
    return {key_C.cast<float>(), shadow_from_camera.cast<float>(),
            float(2 * half_size / RenderTargets::kShadowSize)};
}

}  // namespace

bool isGhostVisible(const Pose& X_WT, const Pose& X_WT_device) {
    return (X_WT.position - X_WT_device.position).norm() > kGhostDistance ||
           X_WT.rotation.angularDistance(X_WT_device.rotation) > kGhostAngle;
}

struct SceneRenderer::Frame {
    Eigen::Matrix4f camera_from_V;
    Eigen::Matrix4f clip_from_camera;
    std::optional<Eigen::Matrix4f> camera_from_T;
    std::optional<Eigen::Matrix4f> camera_from_ghost;
    KeyLight key;
    Eigen::Vector2f near_far;
    Eigen::Vector2f tangents;  // of half the field of view
    float bone_radius;         // m
};

SceneRenderer::SceneRenderer(const GlApi& gl)
    : gl_(gl),
      bone_(gl, "bone", shaders::kMeshVertex, std::string(shaders::kLighting) + shaders::kBoneFragment),
      tool_(gl, "tool", shaders::kToolVertex, std::string(shaders::kLighting) + shaders::kToolFragment),
      ghost_(gl, "ghost", shaders::kToolVertex, shaders::kGhostFragment),
      depth_(gl, "depth", shaders::kDepthVertex, shaders::kDepthFragment),
      background_(gl, "background", shaders::kFullScreenVertex, shaders::kBackgroundFragment),
      occlusion_(gl, "occlusion", shaders::kFullScreenVertex, shaders::kOcclusionFragment),
      composite_(gl, "composite", shaders::kFullScreenVertex, shaders::kCompositeFragment),
      no_attributes_(gl) {}

void SceneRenderer::draw(const FrameView& view, const NodeStore& nodes, const ToolMesh& tool, int width,
                         int height, GLuint target) {
    if (!targets_ || !targets_->hasSize(width, height))
        targets_ = std::make_unique<RenderTargets>(gl_, width, height);
    const Frame frame = makeFrame(view, tool, double(width) / height);

    gl_.Disable(GL_BLEND);
    gl_.Disable(GL_CULL_FACE);
    drawShadowMap(frame, nodes, tool);

    gl_.BindFramebuffer(GL_FRAMEBUFFER, targets_->scene());
    gl_.Viewport(0, 0, width, height);
    gl_.Clear(GL_DEPTH_BUFFER_BIT);
    drawBackground();
    drawBone(frame, nodes);
    drawTool(frame, view, tool);
    drawGhost(frame, tool);
    targets_->resolve();
    drawOcclusion(frame);
    compose(frame, target);
    gl_.check("drawing the scene");
}

SceneRenderer::Frame SceneRenderer::makeFrame(const FrameView& view, const ToolMesh& tool,
                                              double aspect) const {
    const OrbitCamera& camera = view.camera;
    Eigen::AlignedBox3d everything_W;
    extendBy(everything_W, view.X_WV, view.bone_V);
    const Sphere bone = around(everything_W);
    const bool has_tool = view.X_WT && !tool.isEmpty();
    const bool has_ghost = has_tool && view.X_WT_device && isGhostVisible(*view.X_WT, *view.X_WT_device);
    if (has_tool) extendBy(everything_W, *view.X_WT, tool.box());
    if (has_ghost) extendBy(everything_W, *view.X_WT_device, tool.box());
    const Sphere all = around(everything_W);

    Frame frame;
    const Eigen::Matrix4f X_CW = camera.X_CW();
    const DepthRange range = camera.depthRange(all.center, std::max(all.radius, 1e-3) * 1.01);
    frame.camera_from_V = X_CW * matrixOf(view.X_WV);
    frame.clip_from_camera = camera.clipFromCamera(aspect, range);
    if (has_tool) frame.camera_from_T = X_CW * matrixOf(*view.X_WT);
    if (has_ghost) frame.camera_from_ghost = X_CW * matrixOf(*view.X_WT_device);
    frame.near_far = Eigen::Vector2d(range.near, range.far).cast<float>();
    const double tangent = std::tan(OrbitCamera::kFieldOfView / 2);
    frame.tangents = Eigen::Vector2d(tangent * aspect, tangent).cast<float>();
    frame.bone_radius = float(std::max(bone.radius, 1e-4));

    const double shown = kShownBeyondView * camera.distance * tangent * std::hypot(1.0, aspect);
    frame.key = aimKeyLight(camera, shown < bone.radius ? Sphere{camera.target, shown} : bone);
    return frame;
}

void SceneRenderer::drawShadowMap(const Frame& frame, const NodeStore& nodes, const ToolMesh& tool) const {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, targets_->shadow());
    gl_.Viewport(0, 0, RenderTargets::kShadowSize, RenderTargets::kShadowSize);
    gl_.Enable(GL_DEPTH_TEST);
    gl_.DepthFunc(GL_LESS);
    gl_.DepthMask(GL_TRUE);
    gl_.Enable(GL_DEPTH_CLAMP);  // casters between the light and the map's near plane still cast
    gl_.Clear(GL_DEPTH_BUFFER_BIT);
    depth_.use();
    const Eigen::Matrix4f shadow_from_V = frame.key.shadow_from_camera * frame.camera_from_V;
    depth_.set("clip_from_model", shadow_from_V);
    nodes.draw(depth_, shadow_from_V);
    if (frame.camera_from_T) {
        depth_.set("clip_from_model", Eigen::Matrix4f(frame.key.shadow_from_camera * *frame.camera_from_T));
        depth_.set("origin", Eigen::Vector3f(Eigen::Vector3f::Zero()));
        depth_.set("step", Eigen::Vector3f(Eigen::Vector3f::Ones()));
        tool.draw();
    }
    gl_.Disable(GL_DEPTH_CLAMP);
}

void SceneRenderer::drawBackground() const {
    gl_.Disable(GL_DEPTH_TEST);
    background_.use();
    drawFullScreen();
    gl_.Enable(GL_DEPTH_TEST);
}

void SceneRenderer::setLight(const Program& program, const Frame& frame) const {
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindTexture(GL_TEXTURE_2D, targets_->shadowTexture());
    program.set("shadow_map", 0);
    program.set("key_direction", frame.key.direction);
    program.set("shadow_texel", frame.key.shadow_texel);
    program.set("shadow_from_camera", frame.key.shadow_from_camera);
    program.set("clip_from_camera", frame.clip_from_camera);
}

void SceneRenderer::drawBone(const Frame& frame, const NodeStore& nodes) {
    bone_.use();
    setLight(bone_, frame);
    bone_.set("camera_from_model", frame.camera_from_V);
    bone_.set("grain_size", float(kGrain) * frame.bone_radius);
    triangles_drawn_ = nodes.draw(bone_, frame.clip_from_camera * frame.camera_from_V);
}

void SceneRenderer::drawTool(const Frame& frame, const FrameView& view, const ToolMesh& tool) const {
    if (!frame.camera_from_T) return;
    const Eigen::Vector3f glow = view.burr_work == BurrWork::kRemoving ? Eigen::Vector3f(1.9f, 0.30f, 0.02f)
                                 : view.burr_work == BurrWork::kAdding ? Eigen::Vector3f(0.05f, 0.75f, 1.1f)
                                                                       : Eigen::Vector3f(0, 0, 0);
    tool_.use();
    setLight(tool_, frame);
    tool_.set("camera_from_model", *frame.camera_from_T);
    tool_.set("burr_radius", float(view.burr_radius));
    tool_.set("milling_glow", glow);
    tool.draw();
}

// Seen through the bone too, but fainter there: the hand usually is inside when the tool is stopped at the
// surface.
void SceneRenderer::drawGhost(const Frame& frame, const ToolMesh& tool) const {
    if (!frame.camera_from_ghost) return;
    gl_.Enable(GL_BLEND);
    gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    gl_.Enable(GL_CULL_FACE);
    gl_.DepthMask(GL_FALSE);
    ghost_.use();
    ghost_.set("camera_from_model", *frame.camera_from_ghost);
    ghost_.set("clip_from_camera", frame.clip_from_camera);
    constexpr struct {
        GLenum depth_test;
        float strength;
    } kPasses[] = {{GL_GREATER, 0.6f}, {GL_LEQUAL, 0.8f}};
    for (const auto& pass : kPasses) {
        gl_.DepthFunc(pass.depth_test);
        ghost_.set("strength", pass.strength);
        tool.draw();
    }
    gl_.DepthFunc(GL_LESS);
    gl_.DepthMask(GL_TRUE);
    gl_.Disable(GL_CULL_FACE);
    gl_.Disable(GL_BLEND);
}

void SceneRenderer::drawOcclusion(const Frame& frame) const {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, targets_->occlusion());
    gl_.Viewport(0, 0, targets_->occlusionWidth(), targets_->occlusionHeight());
    gl_.Disable(GL_DEPTH_TEST);
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindTexture(GL_TEXTURE_2D, targets_->depthTexture());
    occlusion_.use();
    occlusion_.set("depth_map", 0);
    occlusion_.set("near_far", frame.near_far);
    occlusion_.set("tangents", frame.tangents);
    occlusion_.set("radius", float(kOcclusionRadius) * frame.bone_radius);
    occlusion_.set("max_radius", kOcclusionPicture);
    drawFullScreen();
}

void SceneRenderer::compose(const Frame& frame, GLuint target) const {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target);
    gl_.Viewport(0, 0, targets_->width(), targets_->height());
    const GLuint textures[] = {targets_->colourTexture(), targets_->depthTexture(),
                               targets_->occlusionTexture()};
    for (GLenum unit = 0; unit < 3; ++unit) {
        gl_.ActiveTexture(GL_TEXTURE0 + unit);
        gl_.BindTexture(GL_TEXTURE_2D, textures[unit]);
    }
    composite_.use();
    composite_.set("colour_map", 0);
    composite_.set("depth_map", 1);
    composite_.set("occlusion_map", 2);
    composite_.set("near_far", frame.near_far);
    composite_.set("depth_tolerance", 0.5f * float(kOcclusionRadius) * frame.bone_radius);
    drawFullScreen();
    gl_.ActiveTexture(GL_TEXTURE0);
}

void SceneRenderer::drawFullScreen() const {
    gl_.BindVertexArray(no_attributes_.name());
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
    gl_.BindVertexArray(0);
}

}  // namespace bonemill
