// A hand that another program tells by OpenIGTLink: Debian's example tracker, and peers of our own.
#include <gtest/gtest.h>
#include <signal.h>

#include <bit>
#include <cmath>

#include "common/device_messages/device_messages.h"
#include "common/igtl_wire/igtl_messages.h"
#include "common/rt/clock.h"
#include "common/tcp/dial.h"
#include "tests/integration/bridge/bridge_host.h"
#include "tests/support/places.h"

namespace bonemill {
namespace {

using test::BridgeHost;
using test::Process;
using test::waitFor;
using wire::DriveState;

// The port that peers come to, as the bridge says.
uint16_t igtlPort(Process& bridge) {
    const std::string words = "OpenIGTLink to 127.0.0.1:";
    std::string said;
    waitFor(
        [&] { return (said = bridge.errSoFar()).find(words) != std::string::npos || !bridge.isRunning(); });
    const size_t at = said.find(words);
    return at == std::string::npos ? 0 : uint16_t(std::stoi(said.substr(at + words.size())));
}

class Robot {
  public:
    explicit Robot(uint16_t port) : socket_(dial("127.0.0.1", port, std::chrono::seconds(10)).socket) {}
    // Says where it is, in mm.
    void say(const Eigen::Vector3d& p_mm, const Eigen::Matrix3d& turn = Eigen::Matrix3d::Identity()) {
        Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
        place.linear() = turn;
        place.translation() = p_mm;
        put(igtl::transformFrame("Robot", 0, place));
    }
    void put(const std::string& bytes) { send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL); }
    // The newest wrench that came.
    std::vector<double> wrench() {
        char piece[1 << 14];
        for (ssize_t n; (n = recv(socket_.get(), piece, sizeof piece, MSG_DONTWAIT)) > 0;)
            reader_.take({piece, size_t(n)}, [this](const igtl::Frame& frame) {
                newest_.clear();
                for (size_t at = 4; at + 8 <= frame.body.size(); at += 8) {
                    uint64_t bits = 0;
                    for (size_t n = 0; n < 8; ++n) bits = bits << 8 | uint8_t(frame.body[at + n]);
                    newest_.push_back(std::bit_cast<double>(bits));
                }
            });
        return newest_;
    }

  private:
    Descriptor socket_;
    igtl::FrameReader reader_{{{"NDARRAY", 52, 52}}};
    std::vector<double> newest_;
};

class IgtlBridge : public testing::Test {
  protected:
    std::vector<std::string> command(const std::vector<std::string>& more = {}) {
        std::vector<std::string> words{"bonemill_bridge_igtl", "--igtl-port", "0"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    // The robot says so every 5 ms until the condition holds.
    template <class Condition>
    static bool sayUntil(BridgeHost& host, Robot& robot, const Eigen::Vector3d& p_mm,
                         const Condition& condition) {
        int periods = 0;
        return host.runUntil([&] {
            if (periods++ % 5 == 0) robot.say(p_mm);
            return condition();
        });
    }
};

TEST_F(IgtlBridge, TheExampleTrackerIsAHand) {
    Process bridge(command({"--place-only"}));
    BridgeHost host(bridge);
    ASSERT_TRUE(host.runUntil([&] { return host.hasState(); }));
    EXPECT_FALSE(host.state().inputs & wire::kInputHomed) << "nobody holds it yet";
    EXPECT_EQ(std::string(host.description().name), "OpenIGTLink");
    Process tracker(
        {test::helperDir() + "/igtl_tracker_client", "127.0.0.1", std::to_string(igtlPort(bridge)), "100"});
    ASSERT_TRUE(host.runUntil([&] { return (host.state().inputs & wire::kInputHomed) != 0; }));
    // Its way is (50 cos φ, 50 sin φ, 50 cos φ) mm, chords of 0.2 rad of it.
    double widest = 0, worst = 0;
    for (int n = 0; n < 2000; ++n) {
        host.runPeriods(1);
        if (!(host.state().inputs & wire::kInputHomed)) continue;
        const auto* p = host.state().p_DT;
        worst = std::max({worst, std::abs(p[0] - p[2]), std::abs(std::hypot(p[0], p[1]) - 0.05)});
        widest = std::max(widest, double(p[1]));
    }
    EXPECT_LT(worst, 0.05 * (1 - std::cos(0.2)) + 1e-3) << "two poses at once make one longer chord";
    EXPECT_GT(widest, 0.045);
}

TEST_F(IgtlBridge, ARobotFeelsTheWrenchInItsOwnAxesAndMovesTheHandInOurs) {
    Process bridge(command({"--axes", "-y,x,z", "--origin-mm", "100", "0", "-20", "--max-torque-nm", "0.5"}));
    BridgeHost host(bridge);
    Robot robot(igtlPort(bridge));
    ASSERT_TRUE(sayUntil(host, robot, {110, 20, -15},
                         [&] { return (host.state().inputs & wire::kInputHomed) != 0; }));
    host.want(true, {1, 2, -3, 0, 0, 0.1f});
    ASSERT_TRUE(sayUntil(host, robot, {110, 20, -15}, [&] {
        const std::vector<double> wrench = robot.wrench();
        return wrench.size() == 6 && std::abs(wrench[2] + 3) < 1e-6;
    }));
    const std::vector<double> wrench = robot.wrench();
    EXPECT_NEAR(wrench[0], 2, 1e-6) << "D's y is its x";
    EXPECT_NEAR(wrench[1], -1, 1e-6);
    EXPECT_NEAR(wrench[5], 0.1, 1e-6);
    robot.put(igtl::stringFrame("bonemill_buttons", 0, "remove"));
    ASSERT_TRUE(sayUntil(host, robot, {110, 20, -15}, [&] {
        return (host.state().inputs >> wire::kFirstButtonInput & 3) == kButtonRemove;
    }));
    robot.put(igtl::stringFrame("bonemill_buttons", 0, ""));
    ASSERT_TRUE(sayUntil(host, robot, {110, 20, -15},
                         [&] { return (host.state().inputs >> wire::kFirstButtonInput & 3) == 0; }));
    EXPECT_NEAR(host.state().p_DT[0], -0.020, 1e-9);
    EXPECT_NEAR(host.state().p_DT[1], 0.010, 1e-9);
    EXPECT_NEAR(host.state().p_DT[2], 0.005, 1e-9);
}

TEST_F(IgtlBridge, ARobotThatFallsSilentGetsNoForceAndMayComeAgain) {
    Process bridge(command());
    BridgeHost host(bridge);
    {
        Robot robot(igtlPort(bridge));
        host.want(true, {1, 0, 0, 0, 0, 0});
        ASSERT_TRUE(
            sayUntil(host, robot, {0, 0, 0}, [&] { return host.drive() == DriveState::kOperationEnabled; }));
        ASSERT_TRUE(host.runUntil([&] { return (host.faults() & wire::kFaultSdk) != 0; })) << "silence";
        EXPECT_NE(host.drive(), DriveState::kOperationEnabled);
    }
    host.want(false);
    ASSERT_TRUE(host.runUntil([&] { return !(host.state().inputs & wire::kInputHomed); }));
    Robot again(igtlPort(bridge));
    host.want(true, {1, 0, 0, 0, 0, 0});
    EXPECT_TRUE(
        sayUntil(host, again, {5, 0, 0}, [&] { return host.drive() == DriveState::kOperationEnabled; }));
    EXPECT_TRUE(bridge.isRunning());
}

TEST_F(IgtlBridge, NonsenseMovesNothing) {
    Process bridge(command());
    BridgeHost host(bridge);
    Robot robot(igtlPort(bridge));
    ASSERT_TRUE(
        sayUntil(host, robot, {1, 2, 3}, [&] { return (host.state().inputs & wire::kInputHomed) != 0; }));
    Robot second(igtlPort(bridge)), garbage(igtlPort(bridge));
    garbage.put(std::string(4096, 'x'));
    for (int n = 0; n < 100; ++n) {
        robot.say({1, 2, 3});
        robot.say({50, 0, 0}, Eigen::Matrix3d::Identity() * 2);  // no rotation
        robot.say({50, 0, 0}, -Eigen::Matrix3d::Identity());     // a mirror
        robot.say(Eigen::Vector3d(std::nan(""), 0, 0));
        robot.say({50000, 0, 0});
        second.say({-50, 0, 0});  // the first holds the hand
        host.runPeriods(5);
        ASSERT_NEAR(host.state().p_DT[0], 0.001, 1e-9);
        ASSERT_EQ(host.state().q_DT[0], 1);
    }
    EXPECT_TRUE(bridge.isRunning());
    bridge.signal(SIGTERM);
    EXPECT_TRUE(host.runUntil([&] { return host.state().inputs & wire::kInputLeaving; }));
    EXPECT_EQ(bridge.wait().exit_code, 0);
}

TEST_F(IgtlBridge, AnAddressForOthersNeedsOneWhoMay) {
    const auto ended = test::run({"bonemill_bridge_igtl", "--igtl-address", "0.0.0.0", "--igtl-port", "0"});
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_NE(ended.err.find("--peer"), std::string::npos);
    Process bridge(command({"--peer", "192.0.2.7"}));
    BridgeHost host(bridge);
    Robot stranger(igtlPort(bridge));
    for (int n = 0; n < 50; ++n) stranger.say({1, 2, 3}), host.runPeriods(5);
    EXPECT_FALSE(host.state().inputs & wire::kInputHomed);
}

}  // namespace
}  // namespace bonemill
