#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "render_client/look/camera/camera.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

// Returns the normalised device coordinates of a point in W.
Eigen::Vector3f project(const OrbitCamera& orbit, double aspect, const DepthRange& range,
                        const Vector3d& p_W) {
    const Camera camera = orbit.view();
    const Eigen::Vector4f clip =
        camera.clipFromCamera(aspect, range) * camera.X_CW() * p_W.cast<float>().homogeneous();
    return clip.hnormalized();
}

TEST(OrbitCamera, AzimuthZeroLooksFromTheFrontAndNinetyFromTheLeft) {
    OrbitCamera camera;
    camera.elevation = 0;
    camera.azimuth = 0;
    EXPECT_TRUE(camera.towardsEye_W().isApprox(-Vector3d::UnitY()));
    camera.azimuth = M_PI / 2;
    EXPECT_TRUE(camera.towardsEye_W().isApprox(Vector3d::UnitX()));
    camera.elevation = M_PI / 4;
    EXPECT_TRUE(camera.towardsEye_W().isApprox(Vector3d(1, 0, 1).normalized()));
}

TEST(OrbitCamera, AxesAreRightHandedAndUpPointsUp) {
    OrbitCamera camera;
    for (const double azimuth : {-3.0, -1.0, 0.0, 0.7, 2.5})
        for (const double elevation : {-1.5, -0.4, 0.0, 1.2, 1.55}) {
            camera.azimuth = azimuth;
            camera.elevation = elevation;
            const Eigen::Matrix3d R_WC = camera.R_WC();
            EXPECT_TRUE((R_WC.transpose() * R_WC).isIdentity(1e-9));
            EXPECT_NEAR(R_WC.determinant(), 1, 1e-9);
            EXPECT_GT(R_WC.col(1).dot(camera.up_W()), 0);
        }
}

TEST(OrbitCamera, TheTargetIsInTheMiddleAndAboveIsAbove) {
    OrbitCamera camera;
    camera.target_W = {0.01, -0.2, 0.03};
    const DepthRange range{0.01, 2};
    EXPECT_LT(project(camera, 1.6, range, camera.target_W).head<2>().norm(), 1e-5);
    EXPECT_GT(project(camera, 1.6, range, camera.target_W + Vector3d(0, 0, 0.01)).y(), 0.01);
}

TEST(OrbitCamera, AnotherUpTurnsThePicture) {
    OrbitCamera camera;
    camera.setUp({0, -2, 0});
    camera.elevation = 0.3;
    EXPECT_GT(project(camera, 1, {0.01, 2}, camera.target_W + Vector3d(0, -0.01, 0)).y(), 0.01);
    camera.setUp(Vector3d::Zero());
    EXPECT_EQ(camera.up_W(), Vector3d(Vector3d::UnitZ()));
}

TEST(OrbitCamera, OrbitKeepsTheDistanceAndStopsBelowThePole) {
    OrbitCamera camera;
    camera.distance = 0.2;
    camera.orbit(1.0, 10.0);
    EXPECT_NEAR((camera.eye_W() - camera.target_W).norm(), 0.2, 1e-12);
    EXPECT_DOUBLE_EQ(camera.elevation, OrbitCamera::kMaxElevation);
    camera.orbit(100.0, 0);
    EXPECT_LE(std::abs(camera.azimuth), M_PI);
}

TEST(OrbitCamera, ZoomScalesTheDistanceWithinLimits) {
    OrbitCamera camera;
    camera.distance = 0.2;
    camera.zoom(0.5);
    EXPECT_DOUBLE_EQ(camera.distance, 0.1);
    camera.zoom(0);
    EXPECT_DOUBLE_EQ(camera.distance, OrbitCamera::kMinDistance);
    camera.zoom(1e12);
    EXPECT_DOUBLE_EQ(camera.distance, OrbitCamera::kMaxDistance);
}

TEST(OrbitCamera, PanMovesThePictureByThatPartOfItsHeight) {
    OrbitCamera camera;
    const Vector3d point = camera.target_W;
    camera.pan(0.25, -0.1);
    const Eigen::Vector3f seen = project(camera, 1.5, {0.01, 2}, point);
    EXPECT_NEAR(seen.x() * 1.5 / 2, 0.25, 1e-4);
    EXPECT_NEAR(seen.y() / 2, -0.1, 1e-4);
}

TEST(OrbitCamera, FitShowsEveryCornerAndNearlyFillsThePicture) {
    std::array<Vector3d, 8> corners;
    for (int i = 0; i < 8; ++i)
        corners[size_t(i)] = Vector3d(i & 1 ? 0.08 : 0, i & 2 ? 0.02 : -0.01, i & 4 ? 0.05 : 0.01);
    for (const double aspect : {0.5, 1.0, 1.78})
        for (const double azimuth : {0.0, 0.6, 2.0}) {
            OrbitCamera camera;
            camera.azimuth = azimuth;
            camera.fit(corners, aspect);
            float farthest = 0;
            for (const auto& corner : corners) {
                farthest = std::max(
                    farthest, project(camera, aspect, {0.001, 2}, corner).head<2>().cwiseAbs().maxCoeff());
            }
            EXPECT_LT(farthest, 1.0f);
            EXPECT_GT(farthest, 0.9f);
        }
}

TEST(OrbitCamera, DepthRangeHoldsTheSphereOrStaysInFrontOfTheEye) {
    OrbitCamera camera;
    camera.distance = 0.5;
    const DepthRange outside = camera.view().depthRange(camera.target_W, 0.1);
    EXPECT_NEAR(outside.near, 0.4, 1e-12);
    EXPECT_NEAR(outside.far, 0.6, 1e-12);
    const DepthRange within = camera.view().depthRange(camera.target_W, 3);
    EXPECT_GT(within.near, 0);
    EXPECT_NEAR(within.far, 3.5, 1e-12);
    const DepthRange behind = camera.view().depthRange(camera.eye_W() + camera.towardsEye_W(), 0.1);
    EXPECT_GT(behind.near, 0);
    EXPECT_GT(behind.far, behind.near);
}

// The occlusion takes a face's slope from the depths of neighbouring pixels.
TEST(OrbitCamera, DepthIsFineAtTheFocusWhateverStandsAroundTheEye) {
    constexpr int kHeight = 800;
    for (const double distance : {0.005, 0.034, 0.3, 5.0})
        for (const double radius : {0.02, 0.2, 2.0})
            for (const bool is_microscope : {false, true}) {
                OrbitCamera orbit;
                orbit.distance = distance;
                const Camera camera = is_microscope ? microscopeCamera(orbit.view()) : orbit.view();
                const DepthRange range = camera.depthRange(camera.eye_W, radius);
                ASSERT_LT(range.near, range.far);
                if (range.far < camera.focus) continue;
                const double step = camera.focus * (camera.focus / range.near) * std::pow(2, -24);
                EXPECT_LT(step, 0.02 * camera.metresPerPixel(kHeight)) << distance << ' ' << radius;
            }
}

TEST(OrbitCamera, MetresPerPixelAgreesWithTheProjection) {
    OrbitCamera camera;
    constexpr int kHeight = 600;
    const Vector3d point = camera.target_W + camera.R_WC().col(1) * camera.view().metresPerPixel(kHeight);
    EXPECT_NEAR(project(camera, 1, {0.01, 2}, point).y(), 2.0 / kHeight, 1e-6);
}

}  // namespace
}  // namespace bonemill
