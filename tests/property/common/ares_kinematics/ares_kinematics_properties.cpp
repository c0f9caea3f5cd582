// Makes the round trip over the whole specified workspace: 50 x 50 x 50 mm, 40 degrees about any axis.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <numbers>

#include "common/ares_kinematics/ares_kinematics.h"
#include "common/base/units.h"

namespace bonemill {
namespace {

double fraction() {  // -1 .. 1, both ends included
    constexpr int kSteps = 1'000'000;
    return *rc::gen::inRange(-kSteps, kSteps + 1) / double(kSteps);
}

Pose poseInWorkspace() {
    Pose X_DT;
    for (double& coordinate : X_DT.position) coordinate = 0.025 * fraction();
    const double azimuth = std::numbers::pi * fraction();
    const double height = fraction();
    const double radius = std::sqrt(1 - height * height);
    const Eigen::Vector3d axis(radius * std::cos(azimuth), radius * std::sin(azimuth), height);
    X_DT.rotation = expRotation(axis * (40 * kDegree * fraction()));
    return X_DT;
}

RC_GTEST_PROP(AresKinematicsProperties, ForwardUndoesInverse, ()) {
    const AresKinematics kinematics;
    const Pose X_DT = poseInWorkspace();
    Vector6d q;
    RC_ASSERT(kinematics.inverse(X_DT, q));
    const ForwardSolution solution = kinematics.forward(q, Pose{});
    RC_ASSERT(solution.converged);
    RC_ASSERT((solution.X_DT.position - X_DT.position).norm() < 1e-9);
    RC_ASSERT(logRotation(solution.X_DT.rotation * X_DT.rotation.conjugate()).norm() < 1e-8);
}

RC_GTEST_PROP(AresKinematicsProperties, InverseUndoesForwardFromAnyNearbyStart, ()) {
    const AresKinematics kinematics;
    const Pose start = poseInWorkspace();
    Vector6d q;
    RC_ASSERT(kinematics.inverse(start, q));
    for (double& slider : q) slider += 0.002 * fraction();
    const ForwardSolution solution = kinematics.forward(q, start);
    RC_ASSERT(solution.converged);
    Vector6d back;
    RC_ASSERT(kinematics.inverse(solution.X_DT, back));
    RC_ASSERT((back - q).cwiseAbs().maxCoeff() <= AresKinematics::kForwardTolerance);
}

}  // namespace
}  // namespace bonemill
