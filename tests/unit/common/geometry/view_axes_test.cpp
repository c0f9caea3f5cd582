#include "common/geometry/view_axes.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace bonemill {
namespace {

using Eigen::Vector3d;

const Vector3d kWorldUp = Vector3d::UnitZ();

TEST(ViewAxes, FromTheFrontRightIsThePatientsLeftAndTheEyeIsBeforeThePatient) {
    const Eigen::Matrix3d R_WC = viewAxes(0, 0, kWorldUp);
    EXPECT_TRUE(R_WC.col(0).isApprox(Vector3d::UnitX(), 1e-9));
    EXPECT_TRUE(R_WC.col(1).isApprox(Vector3d::UnitZ(), 1e-9));
    EXPECT_TRUE(R_WC.col(2).isApprox(-Vector3d::UnitY(), 1e-9));
}

TEST(ViewAxes, TurnWithAzimuthAndElevation) {
    const double quarter = std::numbers::pi / 2;
    EXPECT_TRUE(viewAxes(quarter, 0, kWorldUp).col(0).isApprox(Vector3d::UnitY(), 1e-9))
        << "from the patient's left, right in the picture is towards the patient's back";
    EXPECT_GT(viewAxes(0, 1, kWorldUp).col(1).y(), 0.8) << "from above, up leans away from the front";
}

TEST(ViewAxes, AreARotationAlsoAtThePoleAndWithAnyUp) {
    for (const Vector3d& up : {Vector3d(0, 0, 1), Vector3d(0, -3, 0), Vector3d(1, 2, -2)})
        for (const double elevation : {-10.0, 0.4, 10.0}) {
            const Eigen::Matrix3d R_WC = viewAxes(2, elevation, unitUp(up));
            EXPECT_TRUE((R_WC.transpose() * R_WC).isIdentity(1e-9));
            EXPECT_NEAR(R_WC.determinant(), 1, 1e-9);
            EXPECT_GT(R_WC.col(1).dot(unitUp(up)), 0);
        }
}

TEST(ViewAxes, AnUpThatIsNoneIsTheWorlds) {
    EXPECT_EQ(unitUp(Vector3d::Zero()), kWorldUp);
    EXPECT_EQ(unitUp({std::numeric_limits<double>::quiet_NaN(), 0, 1}), kWorldUp);
}

}  // namespace
}  // namespace bonemill
