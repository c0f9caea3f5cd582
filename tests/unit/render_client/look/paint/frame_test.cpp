#include "render_client/look/paint/frame.h"

#include <gtest/gtest.h>

#include "common/geometry/pose.h"

namespace bonemill {
namespace {

// Whatever stands between the light and what is looked at casts a shadow on any machine: nothing of bone and
// tool lies outside of the shadow map's depth.
TEST(Frame, TheShadowMapReachesFromTheToolsEndThroughTheBone) {
    FrameView view;
    view.camera.eye_W = {0, 0, 0.06};
    view.camera.focus = 0.06;
    view.bone_V = {Eigen::Vector3d::Constant(-0.08), Eigen::Vector3d::Constant(0.08)};
    view.X_WT.emplace();
    view.X_WT->rotation = rotationBetween(Eigen::Vector3d::UnitY(), Eigen::Vector3d(-0.55, 0.70, 0.62));
    const Eigen::AlignedBox3f tool_T(Eigen::Vector3f(-0.004f, -0.004f, -0.004f),
                                     Eigen::Vector3f(0.004f, 0.15f, 0.004f));
    const DepthRange range = Frame::neededRange(view, tool_T);
    for (const LightRig light : {LightRig::kRoom, LightRig::kEndoscope, LightRig::kMicroscope}) {
        view.light = light;
        const Frame frame = Frame::make(view, tool_T, 1.6, range);
        const auto depthOf = [&](const Eigen::Matrix4f& X_CB, const Eigen::Vector3f& p_B) {
            return (frame.key.shadow_from_camera * X_CB * p_B.homogeneous()).z();
        };
        for (int i = 0; i < 8; ++i) {
            const auto corner = Eigen::AlignedBox3f::CornerType(i);
            EXPECT_LT(std::abs(depthOf(*frame.X_CT, tool_T.corner(corner))), 1) << i;
            EXPECT_LT(std::abs(depthOf(frame.X_CV, frame.bone_V.corner(corner))), 1) << i;
        }
        EXPECT_LT(depthOf(*frame.X_CT, {0, 0.15f, 0}), depthOf(*frame.X_CT, {0, 0, 0}))
            << "what is nearer to the light is less deep";
    }
}

}  // namespace
}  // namespace bonemill
