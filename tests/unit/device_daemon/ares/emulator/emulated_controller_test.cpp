// The emulated controller with a host, in simulated time.
#include "device_daemon/ares/emulator/emulated_controller.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/device_messages/device_messages.h"
#include "device_daemon/ares/wire/host_session.h"

namespace bonemill {
namespace {

using wire::DriveState;

constexpr wire::Endpoint kController{wire::kLoopback, 4040}, kHost{wire::kLoopback, 4041};
constexpr int64_t kTickNs = 1'000'000;

// The hand goes up by 10 mm in one second, with the pedal down.
Scenario lift() {
    Scenario scenario;
    scenario.path = OperatorPath(
        {{0, Pose{}, kButtonRemove}, {1, {{0, 0, 0.01}, Eigen::Quaterniond::Identity()}, kButtonRemove}});
    scenario.phases = {"lift", "rest"};
    return scenario;
}

// A host that engages as soon as the switch is held.
struct Session {
    explicit Session(const std::vector<std::string>& faults = {}, bool is_homed = true,
                     const Scenario& scenario = lift())
        : controller(scenario, configOf(faults, is_homed), now_ns) {}

    static EmulatedControllerConfig configOf(const std::vector<std::string>& texts, bool is_homed) {
        EmulatedControllerConfig config;
        config.is_homed = is_homed;
        for (const std::string& text : texts) config.faults.push_back(faultSpecOf(text));
        return config;
    }

    void period() {
        now_ns += kTickNs;
        controller.period(now_ns, state);
        auto& session = controller.session();
        if (session.hasHost()) {
            session.seal(state, now_ns);
            host.take(wire::bytesOf(state), kController, now_ns);
        }
        if (const auto* request = host.requestDue(now_ns)) {
            session.take(wire::bytesOf(*request), kHost, now_ns);
            host.take(session.sealDescription(), kController, now_ns);
        }
        if (host_lives) command();
    }

    void command() {
        const DriveState drive = wire::driveStateOf(host.state().statusword);
        const bool is_homed = host.state().inputs & wire::kInputHomed;
        wire::JointCommand command{};
        command.controlword =
            resets ? uint16_t(wire::kControlFaultReset) : controlwordTowards(host.isTrusted(), drive);
        command.mode = is_homed ? wire::kModeTorque : wire::kModeHoming;
        if (drive == DriveState::kOperationEnabled && (host.state().inputs & wire::kInputEnabled))
            command.flags = wire::kCommandEngaged;
        for (float& f : command.force) f = force;
        if (host.seal(command, now_ns)) controller.session().take(wire::bytesOf(command), kHost, now_ns);
        controller.obey(now_ns);
    }

    void run(double seconds) {
        for (int i = 0; i < std::lround(seconds * 1000); ++i) period();
    }

    bool isEngaged() const { return controller.isEngaged(now_ns); }
    double height() const { return controller.plant().X_DT.position.z(); }

    int64_t now_ns = 1'000'000'000;
    EmulatedController controller;
    wire::HostSession<wire::JointPackets> host{{.controller = kController, .seed = 5}};
    wire::JointState state{};
    bool host_lives = true;
    bool resets = false;
    float force = 0;
};

TEST(EmulatedController, TheHandRestsAndBeginsAnewAsItIsTold) {
    Session session;
    session.run(1.5);
    ASSERT_GT(session.height(), 8e-3);
    session.controller.rest();
    session.run(1.5);
    EXPECT_TRUE(session.isEngaged());
    EXPECT_LT(session.height(), 1e-3);
    EXPECT_FALSE(session.state.inputs & (kButtonRemove << wire::kFirstButtonInput));
    session.controller.beginAnew();
    session.run(0.5);
    EXPECT_TRUE(session.state.inputs & (kButtonRemove << wire::kFirstButtonInput));
    EXPECT_NEAR(session.controller.plant().scenario_time, 0.5, 5e-3);
    session.controller.beginAnew();
    session.run(2);
    EXPECT_GT(session.height(), 8e-3);
    EXPECT_NEAR(session.controller.plant().scenario_time, 1.3, 5e-3);
}

TEST(EmulatedController, PlaysItsScenarioWhileTheHostEngages) {
    Session session;
    session.run(0.1);
    EXPECT_TRUE(session.isEngaged());
    EXPECT_TRUE(session.state.inputs & (kButtonRemove << wire::kFirstButtonInput));
    session.run(1.1);
    EXPECT_NEAR(session.height(), 0.01, 1e-3);
    EXPECT_NEAR(session.state.q[0], session.host.state().q[0], 1e-12);
    EXPECT_EQ(session.state.counts[3], std::lround(session.state.q[3] / 5e-6));
    EXPECT_NEAR(session.controller.engagedSeconds(session.now_ns), 1.1, 0.1);
}

TEST(EmulatedController, ItsTimeRestsWhileTheHostIsSilent) {
    Session session;
    session.run(0.5);
    session.host_lives = false;
    session.run(0.2);
    const double time = session.controller.plant().scenario_time;
    session.run(0.5);
    EXPECT_EQ(session.controller.plant().scenario_time, time);
    EXPECT_EQ(session.controller.session().watchdogTrips(), 1u);
    EXPECT_EQ(session.state.statusword & 0x4F, 0x08);
    EXPECT_TRUE(session.state.first_fault & wire::kFaultWatchdog);
}

TEST(EmulatedController, GivesNoForceOnceTheWatchdogHasTripped) {
    Session session;
    session.run(0.2);
    session.force = 5;
    session.run(0.1);
    EXPECT_NEAR(session.state.force[0], 5, 0.01);
    session.host_lives = false;
    session.run(0.005);
    EXPECT_GT(session.state.force[0], 4);
    session.run(0.010);
    EXPECT_NEAR(session.state.force[0], 0, 0.01);
}

TEST(EmulatedController, FindsItsZeroInASecond) {
    Session session({}, false);
    session.run(0.1);
    EXPECT_TRUE(session.state.inputs & wire::kInputHoming);
    EXPECT_EQ(session.state.mode, wire::kModeHoming);
    EXPECT_NEAR(session.state.q[0], 0, 1e-4) << "it counts from where it was switched on";
    EXPECT_FALSE(session.isEngaged());
    session.run(1.2);
    EXPECT_FALSE(session.state.inputs & wire::kInputHoming);
    EXPECT_TRUE(session.state.inputs & wire::kInputHomed);
    EXPECT_GT(session.state.q[0], 0.01);
    EXPECT_TRUE(session.isEngaged());
}

TEST(EmulatedController, HasTheFaultsOfItsDeviceInTheirTime) {
    Session stuck({"stuck-encoder:2@0.5"});
    stuck.run(0.6);
    const double q = stuck.state.q[1], other = stuck.state.q[2];
    stuck.run(0.3);
    EXPECT_EQ(stuck.state.q[1], q);
    EXPECT_NE(stuck.state.q[2], other);
    EXPECT_EQ(stuck.state.active_faults, 0u) << "it does not know";

    Session straight, crooked({"encoder-offset:1:2@0.5"});
    straight.run(0.7);
    crooked.run(0.7);
    EXPECT_NEAR(crooked.state.q[0] - straight.state.q[0], 2e-3, 1e-9);

    Session weak({"dead-amplifier:4@0.2"});
    weak.force = 3;
    weak.run(0.2);
    EXPECT_NEAR(weak.state.force[3], 3, 0.01);
    weak.run(0.3);
    EXPECT_NEAR(weak.state.force[3], 0, 0.01);
    EXPECT_NEAR(weak.state.force[2], 3, 0.01);
}

TEST(EmulatedController, AnOpenChainIsAFaultThatTheHandResets) {
    Session session({"emergency-stop@0.2+0.3", "over-temperature@1.5"});
    session.run(0.4);
    EXPECT_FALSE(session.state.inputs & wire::kInputChainClosed);
    EXPECT_EQ(session.state.first_fault, wire::kFaultEmergencyStop);
    EXPECT_EQ(session.state.bus_mv, 0u);
    session.run(0.3);
    EXPECT_TRUE(session.state.inputs & wire::kInputChainClosed);
    EXPECT_EQ(session.state.first_fault, wire::kFaultEmergencyStop) << "latched";
    bool pressed = false;
    for (int i = 0; i < 300; ++i) {
        session.resets = session.state.inputs & wire::kInputReset;
        pressed |= session.resets;
        session.period();
    }
    EXPECT_TRUE(pressed);
    session.resets = false;
    session.run(0.4);
    EXPECT_TRUE(session.isEngaged());
    session.run(0.3);
    EXPECT_EQ(session.state.first_fault, wire::kFaultOverTemperature);
    EXPECT_GT(session.state.temperature_dc[0], 900);
}

TEST(EmulatedController, SaysThatItsScriptHasEndedUntilItBeginsAnew) {
    Session session;
    const auto has_ended = [&] { return bool(session.state.inputs & wire::kInputScriptEnded); };
    session.run(1);
    EXPECT_FALSE(has_ended());
    session.run(0.5);
    EXPECT_TRUE(has_ended());
    session.run(1);
    EXPECT_TRUE(has_ended()) << "it rests";
    session.controller.beginAnew();
    session.run(0.01);
    EXPECT_FALSE(has_ended()) << "it draws back";
    session.run(1);
    EXPECT_FALSE(has_ended());
    session.run(2);
    EXPECT_TRUE(has_ended());

    Scenario resting = lift();
    resting.path = OperatorPath({{0, Pose{}, 0}});
    Session still({}, true, resting);
    still.run(1);
    EXPECT_TRUE(still.isEngaged());
    EXPECT_FALSE(still.state.inputs & wire::kInputScriptEnded) << "one place is no script";
}

TEST(EmulatedController, SaysThatItLeaves) {
    Session session;
    session.run(0.3);
    const double time = session.controller.plant().scenario_time;
    session.controller.leave();
    session.run(0.2);
    EXPECT_TRUE(session.state.inputs & wire::kInputLeaving);
    EXPECT_NEAR(session.controller.plant().scenario_time, time, 0.002);
}

}  // namespace
}  // namespace bonemill
