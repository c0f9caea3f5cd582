#include <gtest/gtest.h>

#include "common/ares_kinematics/ares_kinematics.h"
#include "common/base/user_error.h"
#include "device_daemon/ares/ares_device/ares_settings.h"

namespace bonemill {
namespace {

std::string complaintOf(const scene::Device& device) {
    try {
        aresConfigOf(device, false);
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

TEST(DescribeAres, NamesThePlaceholderAndItsFigures) {
    const std::string text = describe(aresConfigOf({}, false));
    for (const char* part : {"a placeholder: no dimension of ARES is published", "link", "210 mm", "151 mm",
                             "D (device)", "ball around D's origin", "singularity index 0.291",
                             "50 N and 1 N m", "counterweight", "(0 0 0) mm in D"}) {
        EXPECT_NE(text.find(part), std::string::npos) << part << "\nin\n" << text;
    }
}

TEST(DescribeAres, SaysThatAnEmulatorIsNotAskedForItsHome) {
    const std::string text = describe(aresConfigOf({}, true));
    EXPECT_EQ(text.rfind("ARES emulator", 0), 0u);
    EXPECT_NE(text.find("not checked"), std::string::npos);
}

TEST(SceneAres, ConvertsUnits) {
    scene::Device device;
    device.set_max_torque_nmm(800);
    device.set_encoder_step_um(2);
    device.set_is_counterweighted(false);
    device.set_weight_kg(0.7);
    device.mutable_weight_centre_t_mm()->set_y(20);
    device.mutable_gravity_d()->set_x(3);
    device.mutable_home_p_dt_mm()->set_z(-70);
    device.set_home_tolerance_mm(2);
    const AresDeviceConfig config = aresConfigOf(device, false);
    EXPECT_DOUBLE_EQ(config.max_torque, 0.8);
    EXPECT_DOUBLE_EQ(config.guard.encoder_step, 2e-6);
    EXPECT_DOUBLE_EQ(config.weight.mass, 0.7);
    EXPECT_DOUBLE_EQ(config.weight.centre_T.y(), 0.02);
    EXPECT_EQ(config.weight.down_D, Eigen::Vector3d(1, 0, 0));
    ASSERT_TRUE(config.guard.home);
    EXPECT_DOUBLE_EQ(config.guard.home->X_DT.position.z(), -0.07);
    EXPECT_DOUBLE_EQ(config.guard.home->tolerance, 2e-3);
}

TEST(SceneAres, ACounterweightedArmWeighsNothing) {
    scene::Device device;
    device.set_weight_kg(0.7);
    EXPECT_EQ(aresConfigOf(device, false).weight.mass, 0);
}

TEST(SceneAres, RefusesWhatCannotBe) {
    scene::Device device;
    device.set_link_length_mm(40);
    EXPECT_NE(complaintOf(device).find("link_length_mm"), std::string::npos);
    device = {};
    device.mutable_home_p_dt_mm()->set_z(-90);
    EXPECT_NE(complaintOf(device).find("home_p_DT_mm"), std::string::npos);
    device = {};
    device.set_is_counterweighted(false);
    device.mutable_gravity_d();
    EXPECT_NE(complaintOf(device).find("gravity_D"), std::string::npos);
    EXPECT_EQ(complaintOf({}), "");
}

TEST(WorkspaceFigures, TheReachIsUsableAllAroundAndNotMuchMore) {
    const AresKinematics kinematics;
    for (const double turn : {0.0, 0.35, kSpecifiedTurn}) {
        const double radius = reachRadius(kinematics, turn);
        EXPECT_GT(radius, 0.025);
        EXPECT_LT(radius, kinematics.geometry().stroke / 2);
    }
    EXPECT_GT(reachRadius(kinematics, 0), reachRadius(kinematics, kSpecifiedTurn));
}

}  // namespace
}  // namespace bonemill
