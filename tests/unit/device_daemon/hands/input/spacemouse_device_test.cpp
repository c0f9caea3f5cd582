// The SpaceMouse is heard through a spacenavd of the test: its axes, its buttons, and that it comes and goes.
#include "device_daemon/hands/input/spacemouse_device.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

#include "device_daemon/hands/input/spnav.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/device_daemon/hands/input/input_test_tools.h"

namespace bonemill {
namespace {

using test::comesTrue;
using test::FakeSpacenavd;

class SpaceMouseDeviceTest : public testing::Test {
  protected:
    void start(int protocol, bool has_device = true) {
        spacenavd = std::make_unique<FakeSpacenavd>(path, protocol, has_device);
    }
    bool isThere() { return device.read(0, reading); }
    bool isPressed(uint32_t buttons) { return isThere() && reading.buttons == buttons; }
    // The press comes after the motion, so that who has seen it has the motion, too.
    void move(std::array<int32_t, 6> counts) {
        spacenavd->send({0, counts[0], counts[1], counts[2], counts[3], counts[4], counts[5], 8});
        spacenavd->send({1, 0});
        ASSERT_TRUE(comesTrue([&] { return isPressed(kButtonRemove); }));
    }
    void run(double seconds) {
        for (int i = 0; i < seconds * 1000; ++i) device.read(1e-3, reading);
    }

    test::TemporaryFolder folder;
    const std::string path = folder / "spnav.sock";
    std::unique_ptr<FakeSpacenavd> spacenavd;
    SpaceMouseDevice device{RateConfig{}, Pose{}, path};
    DeviceReading reading;
};

TEST_F(SpaceMouseDeviceTest, MovesAsInThePicture) {
    EXPECT_FALSE(isThere());
    start(1);
    ASSERT_TRUE(comesTrue([&] { return isThere(); }));
    move({350, 0, 0, 0, 0, 0});
    run(1);
    const double full = RateConfig{}.max_speed;
    EXPECT_TRUE(reading.v_DT.isApprox(Eigen::Vector3d(full, 0, 0), 0.02));
    spacenavd->send({2, 0});
    ASSERT_TRUE(comesTrue([&] { return isPressed(0); }));
    move({0, 0, 350, 0, 0, 350});  // into the picture
    run(1);
    EXPECT_TRUE(reading.v_DT.isApprox(Eigen::Vector3d(0, 0, -full), 0.02));
    EXPECT_TRUE(reading.w_DT.isApprox(Eigen::Vector3d(0, 0, -RateConfig{}.max_spin), 0.02));
}

TEST_F(SpaceMouseDeviceTest, ItsButtonsRemoveAddAndSlowDown) {
    start(1);
    ASSERT_TRUE(comesTrue([&] { return isThere(); }));
    spacenavd->send({1, 1});
    ASSERT_TRUE(comesTrue([&] { return isPressed(kButtonAdd); }));
    spacenavd->send({2, 1});
    spacenavd->send({1, 5});
    move({350, 0, 0, 0, 0, 0});
    run(1);
    EXPECT_NEAR(reading.v_DT.x(), RateConfig{}.fine_share * RateConfig{}.max_speed, 1e-4);
}

TEST_F(SpaceMouseDeviceTest, UnpluggedAndPluggedInAgainIsToldBySpacenavd) {
    start(1, false);
    ASSERT_TRUE(comesTrue([&] { return spacenavd->hasClient(); }));
    EXPECT_FALSE(isThere());
    spacenavd->setDevice(true);
    spacenavd->send({3, 0});
    ASSERT_TRUE(comesTrue([&] { return isThere(); }));
    move({350, 0, 0, 0, 0, 0});
    spacenavd->setDevice(false);
    spacenavd->send({3, 1});
    ASSERT_TRUE(comesTrue([&] { return !isThere(); }));
    EXPECT_EQ(reading.buttons, 0u);
    run(1);
    EXPECT_LT(reading.v_DT.norm(), 1e-6);
}

TEST_F(SpaceMouseDeviceTest, ASpacenavdThatEndsIsALostDeviceUntilItIsBack) {
    start(1);
    ASSERT_TRUE(comesTrue([&] { return isThere(); }));
    spacenavd.reset();
    ASSERT_TRUE(comesTrue([&] { return !isThere(); }));
    start(1);
    ASSERT_TRUE(comesTrue([&] { return isThere(); }));
}

TEST_F(SpaceMouseDeviceTest, AnOldSpacenavdGetsAPlainSensitivity) {
    start(0);
    ASSERT_TRUE(comesTrue([&] { return isThere(); }));
    EXPECT_TRUE(comesTrue([&] { return spacenavd->sensitivity() == 1; }));
    move({0, 350, 0, 0, 0, 0});
    run(1);
    EXPECT_NEAR(reading.v_DT.y(), RateConfig{}.max_speed, 0.001);
}

TEST(SpnavSocket, IsThatOfTheEnvironment) {
    const char* old = std::getenv("SPNAV_SOCKET");
    const std::string before = old ? old : "";
    setenv("SPNAV_SOCKET", "/somewhere/else", 1);
    EXPECT_EQ(spnavSocketPath(), "/somewhere/else");
    unsetenv("SPNAV_SOCKET");
    EXPECT_EQ(spnavSocketPath(), "/var/run/spnav.sock");
    if (old) setenv("SPNAV_SOCKET", before.c_str(), 1);
}

TEST(SpnavSocket, AProbeTellsADeviceFromNone) {
    const test::TemporaryFolder folder;
    EXPECT_EQ(probeSpnav(folder / "spnav.sock"), SpnavState::kNoSocket);
    EXPECT_EQ(probeSpnav(folder / std::string(200, 'x')), SpnavState::kSilent);
    for (const bool has_device : {false, true}) {
        const FakeSpacenavd spacenavd(folder / "spnav.sock", 1, has_device);
        EXPECT_EQ(probeSpnav(folder / "spnav.sock"), has_device ? SpnavState::kReady : SpnavState::kNoDevice);
    }
    const FakeSpacenavd old(folder / "spnav.sock", 0, true);
    EXPECT_EQ(probeSpnav(folder / "spnav.sock"), SpnavState::kReady);
}

TEST(FullScale, IsTheUsualOneUntilMoreIsSeen) {
    FullScale scale;
    EXPECT_FLOAT_EQ(scale.shareOf(175), 0.5f);
    EXPECT_FLOAT_EQ(scale.shareOf(-350), -1);
    EXPECT_FLOAT_EQ(scale.shareOf(700), 1);
    EXPECT_FLOAT_EQ(scale.shareOf(350), 0.5f);
    for (const int32_t nonsense : {INT32_MIN, INT32_MAX, 100000}) EXPECT_EQ(scale.shareOf(nonsense), 0);
    EXPECT_FLOAT_EQ(scale.shareOf(350), 0.5f);
}

}  // namespace
}  // namespace bonemill
