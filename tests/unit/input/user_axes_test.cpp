// The user's axes are those of the first picture.
#include "device_daemon/input/user_axes.h"

#include <gtest/gtest.h>

#include <numbers>

namespace bonemill {
namespace {

const Eigen::Vector3d kWorldUp = Eigen::Vector3d::UnitZ();

TEST(UserAxes, FromTheFrontRightIsThePatientsLeftAndTowardsTheUserIsForward) {
    const Eigen::Quaterniond R_DU = userAxesOf(0, 0, kWorldUp, Eigen::Quaterniond::Identity());
    EXPECT_TRUE((R_DU * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitX(), 1e-9));
    EXPECT_TRUE((R_DU * Eigen::Vector3d::UnitY()).isApprox(Eigen::Vector3d::UnitZ(), 1e-9));
    EXPECT_TRUE((R_DU * Eigen::Vector3d::UnitZ()).isApprox(-Eigen::Vector3d::UnitY(), 1e-9));
}

TEST(UserAxes, TurnWithTheCameraAndWithTheDevice) {
    const double quarter = std::numbers::pi / 2;
    // From the patient's left: right in the picture is towards the patient's back.
    const Eigen::Quaterniond from_left = userAxesOf(quarter, 0, kWorldUp, Eigen::Quaterniond::Identity());
    EXPECT_TRUE((from_left * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-9));
    const Eigen::Quaterniond R_WD(Eigen::AngleAxisd(quarter, Eigen::Vector3d::UnitZ()));
    const Eigen::Quaterniond R_DU = userAxesOf(quarter, 0, kWorldUp, R_WD);
    EXPECT_TRUE((R_DU * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitX(), 1e-9));
    // From above, up in the picture leans away from the front.
    const Eigen::Quaterniond from_above = userAxesOf(0, 1, kWorldUp, Eigen::Quaterniond::Identity());
    EXPECT_GT((from_above * Eigen::Vector3d::UnitY()).y(), 0.8);
}

}  // namespace
}  // namespace bonemill
