// Six slider positions never give a wrong pose: over random poses of everything that stroke, lean, turn and
// conditioning allow, the search returns the true pose or an error, from the neutral pose and from any other.
//
// There are as many poses as a few seconds allow; BONEMILL_POSES sets another number. Seven million have been
// tried without a wrong one.
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "common/ares_kinematics/ares_kinematics.h"
#include "common/base/units.h"

namespace bonemill {
namespace {

constexpr int kDefaultPoses = 200'000;

int poseCount() {
    const char* wanted = std::getenv("BONEMILL_POSES");
    return wanted ? std::atoi(wanted) : kDefaultPoses;
}

class WorkspacePoses {
  public:
    explicit WorkspacePoses(const AresKinematics& kinematics) : kinematics_(kinematics) {}

    // Draws from the specified workspace: 50 x 50 x 50 mm, turned by up to 40 degrees about any axis.
    Pose specified() { return drawInside({0.025, 0.025, 0.025}, 40 * kDegree); }
    // Draws from all that the mechanism allows.
    Pose mechanical() { return drawInside({0.11, 0.11, 0.1}, kMaxTurn); }

  private:
    Pose drawInside(const Eigen::Vector3d& half_box, double largest_turn) {
        Pose X_DT;
        do X_DT = draw(half_box, largest_turn);
        while (!isUsable(X_DT));
        return X_DT;
    }
    Pose draw(const Eigen::Vector3d& half_box, double largest_turn) {
        std::uniform_real_distribution<double> uniform(-1, 1);
        std::normal_distribution<double> normal;
        Pose X_DT;
        for (int i = 0; i < 3; ++i) X_DT.position[i] = half_box[i] * uniform(random_);
        const Eigen::Vector3d axis(normal(random_), normal(random_), normal(random_));
        X_DT.rotation = expRotation(axis.normalized() * (largest_turn * std::cbrt(uniform(random_))));
        return X_DT;
    }
    bool isUsable(const Pose& X_DT) const {
        Matrix6d J_inv;
        return kinematics_.workspaceFaults(X_DT) == kWorkspaceOk &&
               kinematics_.inverseJacobian(X_DT, J_inv) && kinematics_.isOwnAssembly(J_inv) &&
               singularityIndex(J_inv) >= kMinSingularityIndex;
    }

    const AresKinematics& kinematics_;
    std::mt19937_64 random_{20120101};
};

struct Outcomes {
    int right = 0, refused = 0, wrong = 0;

    void count(const AresKinematics& kinematics, const Pose& truth, const Pose& start) {
        Vector6d q;
        ASSERT_TRUE(kinematics.inverse(truth, q));
        const Location location = locate(kinematics, q, start);
        const double turn = logRotation(location.X_DT.rotation * truth.rotation.conjugate()).norm();
        const bool is_right = (location.X_DT.position - truth.position).norm() < 1e-7 && turn < 1e-6;
        ++(!location.isBelieved() ? refused : is_right ? right : wrong);
    }
    int total() const { return right + refused + wrong; }
};

TEST(PoseSearchProperties, IsRightOrRefusesOverTheWholeMechanism) {
    const AresKinematics kinematics;
    WorkspacePoses poses(kinematics);
    Outcomes cold, from_anywhere;
    Pose last;
    for (int i = 0; i < poseCount(); ++i) {
        const Pose truth = poses.mechanical();
        cold.count(kinematics, truth, Pose{});
        from_anywhere.count(kinematics, truth, last);
        last = truth;
    }
    EXPECT_EQ(cold.wrong, 0);
    EXPECT_EQ(from_anywhere.wrong, 0);
    EXPECT_LT(cold.refused, 0.01 * cold.total());
    EXPECT_LT(from_anywhere.refused, 0.02 * from_anywhere.total());
}

TEST(PoseSearchProperties, IsRightOverTheSpecifiedWorkspace) {
    const AresKinematics kinematics;
    WorkspacePoses poses(kinematics);
    Outcomes cold;
    for (int i = 0; i < poseCount() / 2; ++i) cold.count(kinematics, poses.specified(), Pose{});
    EXPECT_EQ(cold.right, cold.total());
}

TEST(PoseSearchProperties, FollowsAHandThatMovesOnePeriodFurther) {
    const AresKinematics kinematics;
    WorkspacePoses poses(kinematics);
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    Outcomes warm;
    for (int i = 0; i < poseCount() / 2; ++i) {
        const Pose truth = poses.mechanical();
        const Eigen::Vector3d way(normal(random), normal(random), normal(random));
        const Eigen::Vector3d turn(normal(random), normal(random), normal(random));
        // 3 m/s and 60 rad/s, for 1 ms.
        warm.count(kinematics, truth, truth.incremented(3e-3 * way.normalized(), 0.06 * turn.normalized()));
    }
    EXPECT_EQ(warm.right, warm.total());
}

}  // namespace
}  // namespace bonemill
