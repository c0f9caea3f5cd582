#include "render_client/look/paint/frame.h"

#include <algorithm>
#include <cmath>

#include "render_client/look/paint/shadow_map.h"

namespace bonemill {
namespace {

constexpr double kGhostDistance = 1.5e-4;  // m
constexpr double kGhostAngle = 0.03;       // rad
// How many half picture diagonals at the target the shadow map covers when one is close.
constexpr double kShownBeyondView = 2.0;
constexpr float kShadowReach = 4;    // in burr radii, so are the two below
constexpr float kShadowedShaft = 5;  // length
constexpr float kShadowedThickness = 0.5f;
constexpr double kFieldRadius = 0.48;   // of the shorter side of the picture
constexpr double kBlur = 0.06;          // of the picture's height, one picture height away from the focus
constexpr double kReach = 1.7;          // of the distance to the focus
constexpr double kCastersGrow = 1.5;    // bone may be added
constexpr double kMinScene = 1e-3;      // m, radius
constexpr double kSmallestBone = 1e-4;  // m, radius

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

// It meets the surface head-on: as bright as the room's it would leave bone white, without its relief.
constexpr float kMicroscopeStrength = 0.7f;

// Towards the key light (C), of any length. A microscope's light comes in beside the eyepieces.
Eigen::Vector3d directionOf(LightRig light) {
    switch (light) {
        case LightRig::kEndoscope:
            return {-0.22, 0.32, 1.0};
        case LightRig::kMicroscope:
            return {-0.04, 0.08, 1.0};
        case LightRig::kRoom:
            break;
    }
    return {-0.55, 0.70, 0.62};
}

// The light's shadow map covers the first sphere, and along the light all of the second: what stands between
// the light and what it covers casts a shadow, too. Its depth grows in steps, so that it rests while the tool
// moves.
KeyLight aimKeyLight(const Camera& camera, LightRig light, const Sphere& lit_W, const Sphere& casters_W) {
    const Eigen::Vector3d key_C = directionOf(light).normalized();
    const double half_size = std::max(lit_W.radius, kSmallestBone);
    const double needed = (casters_W.center - lit_W.center).norm() + kCastersGrow * casters_W.radius;
    const double half_depth = half_size * std::exp2(std::ceil(std::log2(std::max(needed / half_size, 1.0))));
    Eigen::Matrix3d R_LC;
    R_LC.row(2) = -key_C;  // depth grows away from the light
    R_LC.row(0) = Eigen::Vector3d::UnitY().cross(key_C).normalized();
    R_LC.row(1) = key_C.cross(Eigen::Vector3d(R_LC.row(0)));
    const Eigen::Vector3d center_C = camera.R_WC.transpose() * (lit_W.center - camera.eye_W);
    const Eigen::Array3d scale(1 / half_size, 1 / half_size, 1 / half_depth);
    Eigen::Matrix4d shadow_from_camera = Eigen::Matrix4d::Identity();
    shadow_from_camera.topLeftCorner<3, 3>() = R_LC.array().colwise() * scale;
    shadow_from_camera.topRightCorner<3, 1>() = -(R_LC * center_C).array() * scale;
    return {key_C.cast<float>(),
            shadow_from_camera.cast<float>(),
            float(2 * half_size / ShadowMap::kSize),
            light == LightRig::kEndoscope ? float(kReach * camera.focus) : 0,
            light == LightRig::kMicroscope ? kMicroscopeStrength : 1,
            light != LightRig::kRoom};
}

}  // namespace

Eigen::Matrix4f matrixOf(const Pose& X_AB) {
    Eigen::Matrix4f matrix = Eigen::Matrix4f::Identity();
    matrix.topLeftCorner<3, 3>() = X_AB.rotation.toRotationMatrix().cast<float>();
    matrix.topRightCorner<3, 1>() = X_AB.position.cast<float>();
    return matrix;
}

bool isGhostVisible(const Pose& X_WT, const Pose& X_WT_device) {
    return (X_WT.position - X_WT_device.position).norm() > kGhostDistance ||
           X_WT.rotation.angularDistance(X_WT_device.rotation) > kGhostAngle;
}

namespace {

bool showsTool(const FrameView& view, const Eigen::AlignedBox3f& tool_T) {
    return view.X_WT && !tool_T.isEmpty();
}
// The hand's is blue, an expert's is amber.
std::vector<std::pair<Pose, Eigen::Vector3f>> ghostsOf(const FrameView& view,
                                                       const Eigen::AlignedBox3f& tool_T) {
    std::vector<std::pair<Pose, Eigen::Vector3f>> ghosts;
    if (!showsTool(view, tool_T)) return ghosts;
    if (view.X_WT_device && isGhostVisible(*view.X_WT, *view.X_WT_device))
        ghosts.emplace_back(*view.X_WT_device, Eigen::Vector3f(0.35f, 0.80f, 1.0f));
    if (view.X_WT_expert) ghosts.emplace_back(*view.X_WT_expert, Eigen::Vector3f(1.0f, 0.55f, 0.08f));
    return ghosts;
}
// The shaft is as thick as the tool's box is aside, at most as the burr.
ToolShadow shadowOf(const FrameView& view, const Eigen::Matrix4f& X_CT, const Eigen::AlignedBox3f& tool_T) {
    const auto radius = float(view.burr_radius);
    const float length = std::clamp(tool_T.max().y(), 0.0f, kShadowedShaft * radius);
    const auto place = [&](float y) -> Eigen::Vector3f {
        return X_CT.topLeftCorner<3, 3>() * Eigen::Vector3f(0, y, 0) + X_CT.topRightCorner<3, 1>();
    };
    return {place(0), place(length), radius, kShadowedThickness * radius, kShadowReach * radius};
}

Eigen::AlignedBox3d boneIn(const FrameView& view) {
    Eigen::AlignedBox3d box_W;
    extendBy(box_W, view.X_WV, view.bone_V);
    return box_W;
}

}  // namespace

std::vector<Eigen::AlignedBox3f> ToolShadow::boxes(const Eigen::Vector3f& key_direction) const {
    constexpr int kPieces = 4;
    const float room = 1.1f * std::max(burr_radius, shaft_radius) + 0.1f * reach;  // the shadow widens
    std::vector<Eigen::AlignedBox3f> boxes(kPieces);
    for (int piece = 0; piece < kPieces; ++piece)
        for (const Eigen::Vector3f& end : {burr, shaft})
            for (const int side : {piece, piece + 1}) {
                const Eigen::Vector3f p = end - reach * float(side) / kPieces * key_direction;
                boxes[size_t(piece)].extend(Eigen::Vector3f(p.array() - room));
                boxes[size_t(piece)].extend(Eigen::Vector3f(p.array() + room));
            }
    return boxes;
}

DepthRange Frame::neededRange(const FrameView& view, const Eigen::AlignedBox3f& tool_T) {
    Eigen::AlignedBox3d everything_W = boneIn(view);
    extendBy(everything_W, view.X_WV, view.structures_V);
    if (showsTool(view, tool_T)) extendBy(everything_W, *view.X_WT, tool_T);
    for (const auto& [X_WT, colour] : ghostsOf(view, tool_T)) extendBy(everything_W, X_WT, tool_T);
    const Sphere all = around(everything_W);
    return view.camera.depthRange(all.center, std::max(all.radius, kMinScene) * 1.01);
}

Frame Frame::make(const FrameView& view, const Eigen::AlignedBox3f& tool_T, double aspect,
                  const DepthRange& range) {
    const Camera& camera = view.camera;
    const Sphere bone = around(boneIn(view));
    Frame frame;
    const Eigen::Matrix4f X_CW = camera.X_CW();
    frame.X_CV = X_CW * matrixOf(view.X_WV);
    frame.clip_from_camera = camera.clipFromCamera(aspect, range);
    frame.cull_from_V = frame.clip_from_camera * frame.X_CV;
    frame.has_shadow = view.quality == Quality::kFull;
    if (showsTool(view, tool_T)) frame.X_CT = X_CW * matrixOf(*view.X_WT);
    for (const auto& [X_WT, colour] : ghostsOf(view, tool_T))
        frame.ghosts.push_back({X_CW * matrixOf(X_WT), colour});
    frame.near_far = Eigen::Vector2d(range.near, range.far).cast<float>();
    const double tangent = camera.halfTangent();
    frame.tangents = Eigen::Vector2d(tangent * aspect, tangent).cast<float>();
    frame.shift = float(camera.shift);
    frame.field_radius = view.is_field_round ? float(kFieldRadius * std::min(aspect, 1.0)) : 0;
    frame.focus = float(camera.focus);
    frame.blur_per_m = view.has_depth_of_field ? float(kBlur / (2 * camera.focus * tangent)) : 0;
    frame.bone_radius = float(std::max(bone.radius, kSmallestBone));
    frame.bone_V = view.bone_V.cast<float>();
    frame.cuts_V = transformed(view.cuts_W, matrixOf(view.X_WV.inverse()));
    frame.cuts_C = transformed(view.cuts_W, X_CW);

    const double shown = kShownBeyondView * camera.focus * tangent * std::hypot(1.0, aspect);
    Eigen::AlignedBox3d casters_W = boneIn(view);
    if (showsTool(view, tool_T)) extendBy(casters_W, *view.X_WT, tool_T);
    frame.key = aimKeyLight(camera, view.light, shown < bone.radius ? Sphere{camera.target_W(), shown} : bone,
                            around(casters_W));
    if (frame.X_CT && !frame.has_shadow) frame.tool_shadow = shadowOf(view, *frame.X_CT, tool_T);
    return frame;
}

void Frame::setStrength(const Program& program) const {
    program.set("light_reach", key.reach);
    program.set("light_strength", key.strength);
}

void Frame::setLight(const GlApi& gl, const Program& program, GLuint shadow_texture) const {
    gl.ActiveTexture(GL_TEXTURE0);
    gl.BindTexture(GL_TEXTURE_2D, shadow_texture);
    program.set("shadow_map", 0);
    program.set("has_shadow", has_shadow ? 1 : 0);
    program.set("key_direction", key.direction);
    program.set("shadow_texel", key.shadow_texel);
    setStrength(program);
    program.set("shadow_from_camera", key.shadow_from_camera);
    program.set("clip_from_camera", clip_from_camera);
}

}  // namespace bonemill
