#include <gtest/gtest.h>

#include <vector>

#include "render_client/look/camera/camera.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

const Vector3d kUp(0, 0, 1);

TEST(FirstView, LooksAtTheMiddleOfTheBoneFromSoFarThatItFits) {
    const std::vector<Vector3d> small{{0, 0, 0}, {0.01, 0.01, 0.01}}, large{{0, 0, 0}, {0.1, 0.1, 0.1}};
    EXPECT_TRUE(firstView({}, kUp, small, 1.6).target_W.isApprox(Vector3d::Constant(0.005)));
    EXPECT_NEAR(firstView({}, kUp, large, 1.6).distance / firstView({}, kUp, small, 1.6).distance, 10, 1e-9);
    EXPECT_EQ(firstView({}, kUp, {}, 1.6).distance, OrbitCamera().distance) << "nothing is known of the bone";
}

TEST(FirstView, TheFirstWishCountsAndTheSecondFillsItUp) {
    const ViewWish user{.target_W = {}, .distance = 0.2, .azimuth = {}, .elevation = {}};
    const ViewWish scene{.target_W = Vector3d(1, 2, 3), .distance = 0.7, .azimuth = 0.4, .elevation = {}};
    const OrbitCamera camera = firstView(user.orElse(scene), kUp, {}, 1);
    EXPECT_EQ(camera.distance, 0.2);
    EXPECT_EQ(camera.target_W, Vector3d(1, 2, 3));
    EXPECT_EQ(camera.azimuth, 0.4);
    EXPECT_EQ(camera.elevation, OrbitCamera().elevation);
}

TEST(FirstView, IsWithinTheCamerasBounds) {
    const OrbitCamera camera =
        firstView({.target_W = {}, .distance = 1e9, .azimuth = 100, .elevation = 3}, kUp, {}, 1);
    EXPECT_EQ(camera.distance, OrbitCamera::kMaxDistance);
    EXPECT_EQ(camera.elevation, OrbitCamera::kMaxElevation);
}

}  // namespace
}  // namespace bonemill
