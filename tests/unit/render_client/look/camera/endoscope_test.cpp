#include <gtest/gtest.h>

#include <cmath>

#include "render_client/look/camera/camera.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

TEST(Endoscope, LooksAlongTheToolPastTheBurr) {
    Pose X_WT;
    X_WT.position = {0.009, 0.003, 0.0088};
    X_WT.rotation = rotationBetween(Vector3d::UnitY(), Vector3d(0.55, -0.75, 0.35));
    const Camera camera = endoscopeCamera(X_WT, 0.0009);
    const Vector3d ahead = X_WT.rotation * -Vector3d::UnitY();
    EXPECT_GT(camera.forward_W().dot(ahead), std::cos(0.2));
    EXPECT_GT(camera.R_WC.col(1).dot(X_WT.rotation * Vector3d::UnitZ()), 0.9);
    EXPECT_NEAR(camera.R_WC.determinant(), 1, 1e-9);
    const Vector3d burr_C = camera.R_WC.transpose() * (X_WT.position - camera.eye_W);
    EXPECT_NEAR(burr_C.x(), 0, 1e-12);
    EXPECT_LT(burr_C.y(), 0) << "below the middle of the picture";
    EXPECT_LT(burr_C.y() / burr_C.z(), camera.halfTangent()) << "in the picture";
}

}  // namespace
}  // namespace bonemill
