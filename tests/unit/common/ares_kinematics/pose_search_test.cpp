#include <gtest/gtest.h>

#include <cmath>

#include "common/ares_kinematics/ares_kinematics.h"
#include "tests/support/random_direction.h"

namespace bonemill {
namespace {

Vector6d slidersAt(const AresKinematics& kinematics, const Pose& X_DT) {
    Vector6d q;
    EXPECT_TRUE(kinematics.inverse(X_DT, q));
    return q;
}

TEST(PoseSearch, FindsThePoseItsJacobianAndItsIndex) {
    const AresKinematics kinematics;
    const Pose X_DT{{0.01, -0.02, 0.015}, expRotation({0.3, -0.2, 0.4})};
    const Location location = locate(kinematics, slidersAt(kinematics, X_DT), Pose{});
    ASSERT_TRUE(location.isBelieved());
    EXPECT_LT((location.X_DT.position - X_DT.position).norm(), 1e-9);
    Matrix6d J_inv;
    ASSERT_TRUE(kinematics.inverseJacobian(X_DT, J_inv));
    EXPECT_LT((location.J_inv - J_inv).norm(), 1e-7);
    EXPECT_NEAR(location.singularity_index, singularityIndex(J_inv), 1e-7);
}

// Returns a pose within stroke, lean and turn whose Jacobian is as wanted.
template <typename Wanted>
Pose mechanicalPose(const AresKinematics& kinematics, Wanted wanted) {
    std::mt19937 random(11);
    Matrix6d J_inv;
    for (int i = 0; i < 1'000'000; ++i) {
        const Pose X_DT{0.03 * test::randomVector(random),
                        expRotation(kMaxTurn * test::randomDirection(random))};
        const Pose closer{X_DT.position, Eigen::Quaterniond::Identity().slerp(0.97, X_DT.rotation)};
        if (kinematics.workspaceFaults(closer) != kWorkspaceOk) continue;
        if (kinematics.inverseJacobian(closer, J_inv) && wanted(J_inv)) return closer;
    }
    ADD_FAILURE() << "there is no such pose";
    return {};
}

TEST(PoseSearch, DoesNotBelieveAPoseNearASingularity) {
    const AresKinematics kinematics;
    const Pose X_DT = mechanicalPose(kinematics, [&](const Matrix6d& J_inv) {
        return kinematics.isOwnAssembly(J_inv) && singularityIndex(J_inv) < 0.5 * kMinSingularityIndex;
    });
    const Location location = locate(kinematics, slidersAt(kinematics, X_DT), X_DT);
    EXPECT_TRUE(location.is_found);
    EXPECT_EQ(location.faults, kWorkspaceSingular);
    EXPECT_FALSE(location.isBelieved());
}

TEST(PoseSearch, DoesNotBelieveTheMirroredAssembly) {
    const AresKinematics kinematics;
    const Pose X_DT =
        mechanicalPose(kinematics, [&](const Matrix6d& J_inv) { return !kinematics.isOwnAssembly(J_inv); });
    const Location location = locate(kinematics, slidersAt(kinematics, X_DT), X_DT);
    EXPECT_TRUE(location.is_found);
    EXPECT_TRUE(location.faults & kWorkspaceMirrored);
    EXPECT_FALSE(location.isBelieved());
}

TEST(PoseSearch, DoesNotBelieveImpossibleSliders) {
    const AresKinematics kinematics;
    Vector6d q = slidersAt(kinematics, Pose{});
    q[0] += 0.5;
    EXPECT_FALSE(locate(kinematics, q, Pose{}).isBelieved());
    q[0] = std::nan("");
    EXPECT_FALSE(locate(kinematics, q, Pose{}).isBelieved());
}

TEST(PoseSearch, GivesAStopALittleSlack) {
    const AresKinematics kinematics;
    const double end = kinematics.geometry().stroke / 2;
    const auto at = [&](double z) {
        const Pose X_DT{{0, 0, z}, Eigen::Quaterniond::Identity()};
        return locate(kinematics, slidersAt(kinematics, X_DT), X_DT);
    };
    EXPECT_TRUE(at(end + 0.9 * kWorkspaceSlack).isBelieved());
    EXPECT_EQ(at(end + 1.1 * kWorkspaceSlack).faults, kWorkspaceStroke);
}

}  // namespace
}  // namespace bonemill
