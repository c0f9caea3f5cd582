// A robot of ROS 2 is device_daemon's hand: it mills by servo_cp, feels measured_cf, and is stopped as every
// hand is.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <random>

#include "common/device_messages/device_messages.h"
#include "render_client/link/subscribe/scene_subscriber.h"
#include "tests/integration/bridge/bridge_host.h"
#include "tests/integration/ros2/robot_node.h"
#include "tests/integration/ros2/ros_session.h"
#include "tests/support/mutated_bytes.h"

namespace bonemill {
namespace {

using test::BridgeHost;
using test::RobotNode;
using test::ServoPose;

double forceOf(const std::array<double, 6>& wrench) {
    return std::hypot(wrench[0], wrench[1], wrench[2]);
}

// The bridge alone, whose host is played by the test.
class Ros2Bridge : public testing::Test {
  protected:
    Ros2Bridge()
        : bridge_({"bonemill_bridge_ros2", "--device", RobotNode::kNamespace}),
          robot_(test::rosTestDomain()) {}

    test::RosSession session_;
    test::Process bridge_;
    RobotNode robot_;
};

TEST_F(Ros2Bridge, FollowsServoCpAndGivesTheWrenchWithinItsLimits) {
    BridgeHost host(bridge_);
    ASSERT_TRUE(host.runUntil([&] { return host.hasState(); }));
    EXPECT_STREQ(host.description().name, "ROS 2 /lab/robot");
    EXPECT_EQ(host.description().abilities, kAbilityForce | kAbilityTorque | kAbilityOrientation);
    host.want(true, {1, 0, 0, 0, 0, 0});
    host.runPeriods(100);
    EXPECT_FALSE(host.state().inputs & wire::kInputHomed) << "nobody has said where the hand is";
    EXPECT_EQ(forceOf(robot_.wrench()), 0);

    robot_.goTo({.p = {0.01, -0.02, 0.03}, .q = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)}});
    ASSERT_TRUE(host.engage()) << bridge_.errSoFar();
    EXPECT_EQ(host.state().p_DT[0], 0.01);
    EXPECT_EQ(host.state().p_DT[1], -0.02);
    EXPECT_EQ(host.state().p_DT[2], 0.03);
    EXPECT_EQ(host.state().q_DT[0], std::sqrt(0.5));
    EXPECT_EQ(host.state().q_DT[1], std::sqrt(0.5));
    host.want(true, {1, 2, 3, 0.01f, 0.02f, 0.03f});
    EXPECT_TRUE(host.runUntil([&] { return robot_.wrench()[2] > 3 - 1e-6; }));
    EXPECT_NEAR(robot_.wrench()[0], 1, 1e-6);
    EXPECT_NEAR(robot_.wrench()[1], 2, 1e-6);
    EXPECT_NEAR(robot_.wrench()[3], 0.01, 1e-6);
    EXPECT_TRUE(host.runUntil([&] { return robot_.state() == "ENABLED"; }));
    host.want(true, {30, 40, 0, 5, 0, 0});
    EXPECT_TRUE(host.runUntil([&] { return forceOf(robot_.wrench()) > 9.9; }));
    host.runPeriods(50);
    EXPECT_NEAR(forceOf(robot_.wrench()), 10, 1e-5);
    EXPECT_NEAR(robot_.wrench()[3], 0.5, 1e-6);

    robot_.press({1, 0});
    EXPECT_TRUE(
        host.runUntil([&] { return host.state().inputs >> wire::kFirstButtonInput == kButtonRemove; }));
    robot_.press({0, 1, 1});
    EXPECT_TRUE(host.runUntil([&] { return host.state().inputs >> wire::kFirstButtonInput == kButtonAdd; }));
    robot_.press({0, 0, 0});  // who has a third button gives force while it is held
    EXPECT_TRUE(host.runUntil([&] { return !(host.state().inputs & wire::kInputEnabled); }));
    EXPECT_TRUE(host.runUntil([&] { return forceOf(robot_.wrench()) == 0; }));
    bridge_.signal(SIGTERM);
    EXPECT_TRUE(host.runUntil([&] { return bool(host.state().inputs & wire::kInputLeaving); }));
    EXPECT_EQ(bridge_.wait().exit_code, 0);
}

TEST_F(Ros2Bridge, FollowsOneNodeAlone) {
    robot_.goTo({.p = {0.01, 0, 0}});
    BridgeHost host(bridge_);
    ASSERT_TRUE(host.engage());
    RobotNode other(test::rosTestDomain());
    other.goTo({.p = {0.5, 0, 0}});
    EXPECT_TRUE(host.runUntil([&] {
        return bridge_.errSoFar().find("a second node writes /lab/robot/servo_cp") != std::string::npos;
    }));
    host.runPeriods(100);
    EXPECT_EQ(host.state().p_DT[0], 0.01);
}

TEST_F(Ros2Bridge, LeavesWhenTheNodeIsSilentAndSaysWhichFrameItWants) {
    robot_.goTo({});
    BridgeHost host(bridge_);
    host.want(true, {0, 0, 1, 0, 0, 0});
    ASSERT_TRUE(host.runUntil([&] { return forceOf(robot_.wrench()) > 0.99; }));
    robot_.goTo({.frame = "map"});
    EXPECT_TRUE(host.runUntil([&] { return host.faults() & wire::kFaultSdk; }));
    EXPECT_TRUE(host.runUntil([&] { return forceOf(robot_.wrench()) == 0 && robot_.state() == "FAULT"; }));
    host.runUntil([&] { return !bridge_.isRunning(); });
    const test::Finished finished = bridge_.wait();
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_NE(finished.err.find("its frame_id should be bonemill_device"), std::string::npos) << finished.err;
}

// Bytes of any kind come as servo_cp and buttons, with valid ones in between. What DDS takes for a pose may
// be any, and is the daemon's to judge; here the bridge lives, gives no more force than it may, and goes on.
TEST_F(Ros2Bridge, OutlivesWhatIsNoMessage) {
    test::FastNode node(test::rosTestDomain());
    const std::string topic = std::string("rt/") + RobotNode::kNamespace;
    auto servo_cp = node.writer(topic + "/servo_cp", "geometry_msgs::msg::dds_::PoseStamped_");
    auto buttons = node.writer(topic + "/buttons", "sensor_msgs::msg::dds_::Joy_");
    BridgeHost host(bridge_);
    host.want(true, {30, 0, 0, 0, 0, 0});
    ASSERT_TRUE(host.runUntil([&] { return servo_cp.matchedReaders() > 0 && buttons.matchedReaders() > 0; }));
    const auto textOf = [](const std::vector<uint8_t>& bytes) {
        return std::string(bytes.begin(), bytes.end());
    };
    test::CdrMaker joy;
    joy.i32(1).u32(2).text("").u32(0).u32(3).i32(1).i32(0).i32(1);
    const std::string pose = textOf(test::poseStampedBytes({.p = {0.01, 0, 0}}));
    std::mt19937 random(5);
    for (int n = 0; n < 1500; ++n) {
        const std::string bad_pose = test::mutated(pose, random),
                          bad_joy = test::mutated(textOf(joy.bytes()), random);
        servo_cp.write({bad_pose.begin(), bad_pose.end()});
        buttons.write({bad_joy.begin(), bad_joy.end()});
        if (n % 3 == 0) servo_cp.write({pose.begin(), pose.end()});
        host.runPeriods(1);
        ASSERT_LE(forceOf(robot_.wrench()), 10 + 1e-6);
    }
    ASSERT_TRUE(bridge_.isRunning()) << bridge_.errSoFar();
    const auto lead = [&] { servo_cp.write({pose.begin(), pose.end()}); };
    EXPECT_TRUE(host.runUntil([&] {
        lead();
        return forceOf(robot_.wrench()) > 9.9 && host.state().p_DT[0] == 0.01;
    }));
}

TEST(Ros2BridgeWords, RefusesWhatIsNoNameAndNoDomain) {
    for (const char* const name : {"9lives", "a//b", "a b", "/", "a/", "ünder"}) {
        const test::Finished finished = test::run({"bonemill_bridge_ros2", "--device", name});
        EXPECT_EQ(finished.exit_code, 2) << name;
        EXPECT_NE(finished.err.find("give letters, digits and _"), std::string::npos) << finished.err;
    }
    EXPECT_NE(test::run({"bonemill_bridge_ros2", "--ros-domain", "231"}).exit_code, 0);
}

// The whole way: robot, bridge, device_daemon, haptic_server, and a viewer that sees what is milled. D's +y
// is W's up; the robot begins 1.6 mm above the bone's reach.
class RobotMills : public testing::Test {
  protected:
    RobotMills()
        : robot_(test::rosTestDomain()),
          server_(session_.startServer()),
          daemon_(
              session_.startDaemon(std::string("ros2:") + RobotNode::kNamespace, {"--no-enabling-switch"})),
          viewer_({.domain = testDomain(), .session = testSession()}) {
        robot_.goTo({.p = {0, 1.6e-3, 0}});
    }
    double removedNow() {
        viewer_.poll();
        return viewer_.status() ? viewer_.status()->removed_mm3() : 0;
    }
    SafetyState stateNow() {
        viewer_.poll();
        return viewer_.status() ? SafetyState(viewer_.status()->device().state())
                                : SafetyState::kDisconnected;
    }
    size_t timesSaid(const std::string& words) const {
        const std::string text = daemon_->errSoFar();
        size_t count = 0;
        for (size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++count;
        return count;
    }
    // Returns while the robot mills and more than `wanted` mm³ are gone. A busy machine may silence the robot
    // for as long as a dead one: then the device is reset, and the robot comes from above once more.
    void beginToMill(double wanted = 0.1) {
        robot_.press({1});
        ASSERT_TRUE(test::waitFor([&] {
            usleep(5000);
            const double removed = removedNow();
            const SafetyState state = stateNow();
            if (state == SafetyState::kEngaged) {
                robot_.goTo({.p = {0, -2.3e-3, 0}}, 0.01);
            } else {
                robot_.goTo({.p = {0, 1.6e-3, 0}}, 0.01);
                resetDevice();
            }
            return state == SafetyState::kEngaged && forceOf(robot_.wrench()) > 0.2 && removed > wanted;
        })) << forceOf(robot_.wrench())
            << ' ' << removedNow() << daemon_->errSoFar();
    }
    void resetDevice() {
        if (++looks_ % 100 != 0) return;
        topics::Command command;
        command.set_reset_device(true);
        viewer_.sendCommand(std::move(command));
    }

    test::RosSession session_;
    RobotNode robot_;
    std::unique_ptr<test::Process> server_, daemon_;
    SceneSubscriber viewer_;
    int looks_ = 0;
};

TEST_F(RobotMills, ACorridor) {
    beginToMill();
    if (HasFatalFailure()) return;
    const double wanted = removedNow() + 0.5;
    const auto isMilled = [&] { return removedNow() > wanted; };
    for (int round = 0; round < 4 && !isMilled(); ++round) {
        if (round > 0) beginToMill();  // stopped on its way, for a busy machine's silence
        if (HasFatalFailure()) return;
        robot_.goTo({.p = {3e-3, -2.3e-3, 0}}, 0.003);
        test::waitFor(isMilled, std::chrono::seconds(15));
    }
    EXPECT_GT(removedNow(), wanted) << daemon_->errSoFar();
    EXPECT_NE(server_->errSoFar().find("the device is ROS 2 /lab/robot"), std::string::npos)
        << server_->errSoFar();
    daemon_->signal(SIGTERM);
    EXPECT_EQ(daemon_->wait().exit_code, 0);
}

TEST_F(RobotMills, AgainWhenTheDeviceWasReset) {
    beginToMill();
    if (HasFatalFailure()) return;
    robot_.goTo({.p = {0.03, -2.3e-3, 0}});
    ASSERT_TRUE(test::waitFor([&] { return timesSaid(nameOf(StopCause::kPoseJump)) > 0; }));
    ASSERT_TRUE(test::waitFor([&] { return stateNow() != SafetyState::kEngaged; }));
    beginToMill(removedNow());
}

// What every bridge does that has lost its arm for good.
TEST_F(RobotMills, LeavesWhenItsNodeHasDied) {
    beginToMill();
    robot_.beSilent();
    EXPECT_EQ(daemon_->wait().exit_code, 0) << daemon_->errSoFar();
}

struct RobotFault {
    const char* name;
    void (*happen)(RobotNode& robot);
    StopCause cause;
};

void silence(RobotNode& robot) {
    robot.beSilent();
}
void otherFrame(RobotNode& robot) {
    robot.goTo({.p = {0, -2.3e-3, 0}, .frame = "base_link"});
}
void notANumber(RobotNode& robot) {
    robot.goTo({.p = {NAN, -2.3e-3, 0}});
}
void infiniteTurn(RobotNode& robot) {
    robot.goTo({.p = {0, -2.3e-3, 0}, .q = {0, 0, INFINITY, 1}});
}
void noRotation(RobotNode& robot) {
    robot.goTo({.p = {0, -2.3e-3, 0}, .q = {0, 0, 0, 0.9}});
}
void farAway(RobotNode& robot) {
    robot.goTo({.p = {0, 1e6, 0}});
}
void jump(RobotNode& robot) {
    robot.goTo({.p = {0.03, -2.3e-3, 0}});
}
void turnedAtOnce(RobotNode& robot) {
    robot.goTo({.p = {0, -2.3e-3, 0}, .q = {1, 0, 0, 0}});
}
void tooFast(RobotNode& robot) {
    robot.goTo({.p = {0, 0.3, 0}}, 1.5);
}

const RobotFault kRobotFaults[] = {
    {"silence", silence, StopCause::kDeviceLost},
    {"otherFrame", otherFrame, StopCause::kDeviceLost},
    {"notANumber", notANumber, StopCause::kImplausiblePose},
    {"infiniteTurn", infiniteTurn, StopCause::kImplausiblePose},
    {"noRotation", noRotation, StopCause::kImplausiblePose},
    {"farAway", farAway, StopCause::kImplausiblePose},
    {"jump", jump, StopCause::kPoseJump},
    {"turnedAtOnce", turnedAtOnce, StopCause::kPoseJump},
    {"tooFast", tooFast, StopCause::kSpeed},
};

class RobotIsStopped : public RobotMills, public testing::WithParamInterface<RobotFault> {};

TEST_P(RobotIsStopped, AndMillsNoMore) {
    const std::string cause = nameOf(GetParam().cause);
    // A busy machine may stop the robot first, for its silence: then it happens once more.
    bool is_stopped = false;
    for (int round = 0; round < 4 && !is_stopped; ++round) {
        beginToMill();
        if (HasFatalFailure()) return;
        const size_t before = timesSaid(cause);
        GetParam().happen(robot_);
        is_stopped = test::waitFor([&] { return timesSaid(cause) > before; }, std::chrono::seconds(20));
    }
    ASSERT_TRUE(is_stopped) << daemon_->errSoFar();
    EXPECT_TRUE(test::waitFor([&] { return forceOf(robot_.wrench()) == 0; }));
    // The robot is well again, where it was, with its pedal down: nothing begins anew before somebody resets
    // the device.
    robot_.goTo({.p = {0, -2.3e-3, 0}});
    usleep(300'000);
    const double removed = removedNow();
    usleep(300'000);
    EXPECT_EQ(removedNow(), removed);
    EXPECT_EQ(forceOf(robot_.wrench()), 0);
}

INSTANTIATE_TEST_SUITE_P(FaultMatrix, RobotIsStopped, testing::ValuesIn(kRobotFaults),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace bonemill
