// A hand that knows nothing moves the mouse in the viewer's window: whatever it does, no program stumbles, no
// force is above the device's norms, and the safety states see no reason to stop. BONEMILL_MOUSE_SECONDS says
// for how long (docs/explanation/safety.md).
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "common/base/units.h"
#include "common/device_messages/device_state.h"
#include "device_daemon/hands/virtual_handle/virtual_handle.h"
#include "render_client/link/subscribe/scene_subscriber.h"
#include "tests/gl/window/mouse_session.h"
#include "tests/support/dds_session.h"

namespace bonemill {
namespace {

using Clock = std::chrono::steady_clock;
using Words = std::vector<std::string>;

std::chrono::seconds timeWanted() {
    const char* wanted = std::getenv("BONEMILL_MOUSE_SECONDS");
    return std::chrono::seconds(wanted ? std::atoi(wanted) : 5);
}

class RandomHand {
  public:
    explicit RandomHand(uint32_t seed) : random_(seed) {}

    Words next() {
        switch (below(12)) {
            case 0:
                return press(is_milling_, "mouse", "1");
            case 1:
                return press(is_turning_, "mouse", "3");
            case 2:
                return press(is_adding_, "key", "a");
            case 3:
                return press(is_clutched_, "key", "space");
            case 4:
                return {"click", "--repeat", std::to_string(1 + below(8)), "4"};  // deeper
            case 5:
                return {"click", "--repeat", std::to_string(1 + below(4)), "5"};
            case 6:
                return below(4) == 0 ? Words{"key", "g"} : Words{"key", "t"};
            default:
                return {"mousemove", std::to_string(below(test::kMouseScreenWidth)),
                        std::to_string(below(test::kMouseScreenHeight))};
        }
    }

  private:
    int below(int end) { return std::uniform_int_distribution(0, end - 1)(random_); }
    static Words press(bool& is_down, const std::string& what, const std::string& which) {
        is_down = !is_down;
        return {what + (is_down ? "down" : "up"), which};
    }

    std::mt19937 random_;
    bool is_milling_ = true, is_turning_ = false, is_adding_ = false, is_clutched_ = false;
};

// A busy machine has these; the rest would be the programs' own.
bool isOfTheMachineOrTheHand(const std::string& fault) {
    static const std::set<std::string> known{"overrun",       "stale_device",      "motion_clamped",
                                             "force_clamped", "milling_cut_short", "stalled",
                                             "fewer_samples"};
    return known.count(fault) > 0;
}

TEST(RandomMouse, NeverGetsMoreForceThanTheNormsAndStopsNothing) {
    const uint32_t seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::VirtualDisplay display(test::kMouseScreenWidth, test::kMouseScreenHeight);
    test::MouseSession session;
    SceneSubscriber observer({.domain = testDomain(), .session = testSession(), .name = "observer"});
    const auto isHeld = [&] {
        observer.poll();
        return observer.toolState() &&
               observer.toolState()->device_state() == uint32_t(SafetyState::kEngaged);
    };
    ASSERT_TRUE(test::waitFor(isHeld)) << session.whatDaemonSaid() << session.viewer().errSoFar();

    const auto removed = [&] {
        observer.poll();
        return observer.status() ? observer.status()->removed_mm3() : 0;
    };
    const auto force = [&] {
        observer.poll();
        return Eigen::Map<const Eigen::Vector3d>(observer.toolState()->force_n().data()).norm();
    };
    ASSERT_TRUE(test::waitFor([&] {
        display.type({"click", "4"});
        return force() > 0.5;
    })) << "it gets to the bone";
    display.type({"mousedown", "1"});
    ASSERT_TRUE(test::waitFor([&] { return removed() > 0.1; }));

    RandomHand hand(seed);
    for (const auto end = Clock::now() + timeWanted(); Clock::now() < end;) display.type(hand.next());
    EXPECT_TRUE(session.viewer().isRunning());

    const test::MouseSession::Ended ended = session.end();
    for (const test::Finished& program : {ended.viewer, ended.daemon, ended.server})
        EXPECT_EQ(program.exit_code, 0) << program.err;
    const auto device = nlohmann::json::parse(ended.daemon.out), report = nlohmann::json::parse(ended.report);
    EXPECT_GT(device["max_force_n"].get<double>(), 0.5) << "it has felt the bone";
    EXPECT_LE(device["max_force_n"].get<double>(), kMaxHandleForce * (1 + 1e-9));
    EXPECT_LE(device["max_torque_nmm"].get<double>(), kMaxHandleTorque / kMilli * (1 + 1e-9));
    EXPECT_EQ(device["stops"], 0) << ended.daemon.err;
    for (const auto& [fault, ticks] : report["fault_ticks"].items())
        EXPECT_TRUE(isOfTheMachineOrTheHand(fault)) << fault << " for " << ticks << " ticks";
    std::cout << ended.daemon.out << report["fault_ticks"] << std::endl;
}

}  // namespace
}  // namespace bonemill
