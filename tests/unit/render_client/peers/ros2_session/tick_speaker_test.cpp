#include "render_client/peers/ros2_session/tick_speaker.h"

#include <gtest/gtest.h>

namespace bonemill::ros2 {
namespace {

constexpr int64_t kTickNs = 1'000'000;

Pose moving(double t, const Eigen::Vector3d& v, const Eigen::Vector3d& w) {
    return {v * t, Eigen::Quaterniond(Eigen::AngleAxisd(w.norm() * t, w.normalized()))};
}

TEST(HandVelocity, IsThatOfAnEvenMotion) {
    const Eigen::Vector3d v(0.1, -0.2, 0.3), w(1, 2, -3);
    HandVelocity velocity;
    EXPECT_FALSE(velocity.take(moving(0, v, w), 0));
    for (int n = 1; n < 50; ++n) {
        const auto motion = velocity.take(moving(n * 1e-3, v, w), n * kTickNs);
        ASSERT_TRUE(motion);
        EXPECT_LT((motion->v_WT - v).norm(), 1e-9);
        EXPECT_LT((motion->w_WT - w).norm(), 1e-9);
    }
}

TEST(HandVelocity, BeginsAnewAfterAPauseAndABackwardsClock) {
    HandVelocity velocity;
    velocity.take({}, 0);
    EXPECT_TRUE(velocity.take({}, kTickNs));
    EXPECT_FALSE(velocity.take({{1, 0, 0}, Eigen::Quaterniond::Identity()}, 100 * kTickNs));
    EXPECT_TRUE(velocity.take({{1, 0, 0}, Eigen::Quaterniond::Identity()}, 101 * kTickNs));
    EXPECT_FALSE(velocity.take({}, 101 * kTickNs));
    EXPECT_FALSE(velocity.take({}, 50 * kTickNs));
}

}  // namespace
}  // namespace bonemill::ros2
