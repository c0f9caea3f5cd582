// Every fault in every state: where it leads, how soon, and that the force never leaves the ramp.
// docs/explanation/safety.md shows the table that comes out; BONEMILL_WRITE_DOCS=1 writes it there.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/support/places.h"
#include "tests/unit/device_daemon/control/device_loop/loop_rig.h"

namespace bonemill {
namespace {

using test::LoopRig;

constexpr double kMostForceAfter = 0.05;  // s after a fault, on every wire

struct FaultCase {
    const char* name;
    void (*inject)(LoopRig&);  // once
    SafetyState when_engaged;
    StopCause cause;
    double within;         // s: engaged until the state is there
    bool is_slow = false;  // what it passes is a sum over seconds: until then nothing is wrong
};

void silence(LoopRig& rig) {
    rig.is_server_there = false;
}
void notANumber(LoopRig& rig) {
    rig.server = [](WrenchCommand& c) { c.f_hand_D[0] = NAN; };
}
void forgedWrench(LoopRig& rig) {
    rig.server = [](WrenchCommand& c) { LoopRig::setForce(c, 300), c.t_hand_D[1] = 5.7; };
}
void alternating(LoopRig& rig) {
    rig.server = [](WrenchCommand& c) { LoopRig::setForce(c, c.f_hand_D[2] > 0 ? -50 : 50); };
}
template <StopCause cause>
void reported(LoopRig& rig) {
    rig.device.reading.fault = cause;
}

const FaultCase kFaults[] = {
    {"haptic_server silent (killed, stopped, hung)", silence, SafetyState::kPaused, StopCause::kNone, 0.021},
    {"commands that are no numbers", notANumber, SafetyState::kPaused, StopCause::kNone, 0.021},
    {"forged wrench, 300 N and 5.7 N·m", forgedWrench, SafetyState::kEngaged, StopCause::kNone, 0},
    {"wrench of ±50 N in turn every ms", alternating, SafetyState::kEngaged, StopCause::kNone, 0},
    {"enabling switch released", [](LoopRig& rig) { rig.device.reading.status &= ~uint32_t(kStatusEnabled); },
     SafetyState::kReady, StopCause::kNone, 0.001},
    {"device silent (unplugged, its program dead), or another one than before",
     [](LoopRig& rig) { rig.device.is_heard = false; }, SafetyState::kDisconnected, StopCause::kDeviceLost,
     0.022},
    {"power off", [](LoopRig& rig) { rig.device.reading.status &= ~uint32_t(kStatusPowered); },
     SafetyState::kConnected, StopCause::kNone, 0.001},
    {"emergency stop pressed", [](LoopRig& rig) { rig.device.reading.status |= kStatusEmergencyStop; },
     SafetyState::kEmergencyStop, StopCause::kEmergencyStop, 0.001},
    {"handle at 2 m/s",
     [](LoopRig& rig) {
         rig.device.reading.v_DT = {2, 0, 0};
     },
     SafetyState::kProtectiveStop, StopCause::kSpeed, 0.003},
    {"motors drive the hand at 10 N · 0.9 m/s, 6 W allowed",
     [](LoopRig& rig) {
         rig.device.reading.v_DT = {0, 0, 0.9};
     },
     SafetyState::kProtectiveStop, StopCause::kPower, 0.03},
    {"motors drive the hand on and on at 5 W",
     [](LoopRig& rig) {
         rig.device.reading.v_DT = {0, 0, 0.5};
     },
     SafetyState::kProtectiveStop, StopCause::kEnergy, 1.0, true},
    {"dead amplifier", [](LoopRig& rig) { rig.device.is_amplifier_dead = true; }, SafetyState::kFault,
     StopCause::kForceMismatch, 0.1},
    {"motor at its highest temperature", [](LoopRig& rig) { rig.device.reading.load = 1; },
     SafetyState::kProtectiveStop, StopCause::kOverTemperature, 0.001},
    {"near a singularity", reported<StopCause::kSingularity>, SafetyState::kProtectiveStop,
     StopCause::kSingularity, 0.001},
    {"packets come late", reported<StopCause::kLatePackets>, SafetyState::kProtectiveStop,
     StopCause::kLatePackets, 0.001},
    {"position sensor stuck", reported<StopCause::kSensorStuck>, SafetyState::kFault, StopCause::kSensorStuck,
     0.001},
    {"pose jumps", reported<StopCause::kPoseJump>, SafetyState::kFault, StopCause::kPoseJump, 0.001},
    {"no pose fits the sensors, or a number is none", reported<StopCause::kImplausiblePose>,
     SafetyState::kFault, StopCause::kImplausiblePose, 0.001},
    {"the device's own fault", reported<StopCause::kDeviceFault>, SafetyState::kFault,
     StopCause::kDeviceFault, 0.001},
};

DeviceLoopConfig config() {
    DeviceLoopConfig config;
    config.motion.max_power = 6;
    return config;
}

void bringTo(SafetyState state, LoopRig& rig) {
    DeviceReading& reading = rig.device.reading;
    rig.device.measures_force = true;
    switch (state) {
        case SafetyState::kDisconnected:
            rig.run(0.01);
            rig.device.is_heard = false;
            break;
        case SafetyState::kConnected:
            reading.status = 0;
            break;
        case SafetyState::kHoming:
            reading.status = kStatusPowered | kStatusHoming;
            break;
        case SafetyState::kReady:
            break;
        case SafetyState::kEngaged:
            rig.engage();
            break;
        case SafetyState::kPaused:
            rig.engage();
            rig.is_server_there = false;
            break;
        case SafetyState::kProtectiveStop:
            reading.fault = StopCause::kSingularity;
            break;
        case SafetyState::kEmergencyStop:
            reading.status |= kStatusEmergencyStop;
            break;
        case SafetyState::kFault:
            reading.fault = StopCause::kDeviceFault;
            break;
    }
    rig.run(0.1);
    reading.fault = StopCause::kNone;
    rig.run(state == SafetyState::kEngaged ? 0.4 : 0.01);
    ASSERT_EQ(rig.state(), state);
}

struct Outcome {
    SafetyState state;
    StopCause cause;
    double state_after = 0;  // s, when the last state was reached
    double force_after = 0;  // s, when the last force was given
    double largest_force = 0;
    double steepest_rise = 0;  // N in a period after the state was left
};

Outcome outcomeOf(const FaultCase& fault, SafetyState start) {
    LoopRig rig(config());
    bringTo(start, rig);
    fault.inject(rig);
    Outcome outcome{.state = rig.state(), .cause = rig.cause()};
    double before = rig.force();
    for (int i = 1; i <= 1500; ++i) {
        rig.step();
        if (rig.state() != outcome.state) outcome.state_after = i * LoopRig::kPeriod;
        outcome.state = rig.state();
        outcome.cause = rig.cause();
        if (rig.force() > 0) outcome.force_after = (i + 1) * LoopRig::kPeriod;
        outcome.largest_force = std::max(outcome.largest_force, rig.force());
        if (rig.state() != SafetyState::kEngaged)
            outcome.steepest_rise = std::max(outcome.steepest_rise, rig.force() - before);
        before = rig.force();
    }
    return outcome;
}

// Outside of `engaged` a state gives no force, and a fault can only make it worse.
bool isNoBetter(SafetyState start, SafetyState end) {
    return end != SafetyState::kEngaged || start == SafetyState::kEngaged;
}

TEST(FaultMatrix, EngagedEveryFaultLeadsToItsStateInItsTime) {
    for (const FaultCase& fault : kFaults) {
        const Outcome outcome = outcomeOf(fault, SafetyState::kEngaged);
        EXPECT_EQ(nameOf(outcome.state), std::string(nameOf(fault.when_engaged))) << fault.name;
        EXPECT_EQ(nameOf(outcome.cause), std::string(nameOf(fault.cause))) << fault.name;
        EXPECT_LE(outcome.state_after, fault.within + 1e-9) << fault.name;
        EXPECT_LE(outcome.largest_force, 20 * (1 + 1e-12)) << fault.name;
        EXPECT_LE(outcome.steepest_rise, 1e-9) << fault.name;  // it only falls once the state is left
        if (outcome.state == SafetyState::kEngaged) continue;
        const bool is_stop = fault.cause != StopCause::kNone && fault.cause != StopCause::kDeviceLost;
        const double ramp = outcome.state == SafetyState::kEmergencyStop ? 0
                            : is_stop                                    ? 0.01
                                                                         : SafetyConfig{}.ramp_time;
        EXPECT_LE(outcome.force_after, outcome.state_after + ramp + 1e-9) << fault.name;
        if (!fault.is_slow) EXPECT_LE(outcome.force_after, kMostForceAfter + 1e-9) << fault.name;
    }
}

TEST(FaultMatrix, InEveryOtherStateNoFaultGivesForce) {
    for (uint32_t start = 0; start < kSafetyStateCount; ++start) {
        if (SafetyState(start) == SafetyState::kEngaged) continue;
        for (const FaultCase& fault : kFaults) {
            const Outcome outcome = outcomeOf(fault, SafetyState(start));
            EXPECT_EQ(outcome.largest_force, 0) << fault.name << " in " << nameOf(SafetyState(start));
            EXPECT_TRUE(isNoBetter(SafetyState(start), outcome.state)) << fault.name;
        }
    }
}

std::string matrix() {
    std::ostringstream out;
    out << "| fault | engaged | cause | state after | no force after | in the other states "
           "|\n|---|---|---|--:|--:|---|\n";
    for (const FaultCase& fault : kFaults) {
        const Outcome engaged = outcomeOf(fault, SafetyState::kEngaged);
        const bool goes_on = engaged.state == SafetyState::kEngaged;
        out << "| " << fault.name << " | " << (goes_on ? "goes on, limited" : nameOf(engaged.state)) << " | "
            << (engaged.cause == StopCause::kNone ? "" : nameOf(engaged.cause)) << " | ";
        if (!goes_on) out << std::lround(1e3 * engaged.state_after) << " ms";
        out << " | ";
        if (!goes_on) out << std::lround(1e3 * engaged.force_after) << " ms";
        out << " | ";
        std::string changes;
        for (uint32_t start = 0; start < kSafetyStateCount; ++start) {
            if (SafetyState(start) == SafetyState::kEngaged) continue;
            const Outcome other = outcomeOf(fault, SafetyState(start));
            if (other.state == SafetyState(start)) continue;
            changes += (changes.empty() ? "" : "; ") + std::string(nameOf(SafetyState(start))) + " → " +
                       nameOf(other.state);
        }
        out << (changes.empty() ? "stays" : changes) << " |\n";
    }
    return out.str();
}

TEST(FaultMatrix, DocsHoldTheTable) {
    const std::string page = test::sourceDir() + std::string("/docs/explanation/safety.md");
    std::ifstream stream(page);
    std::string text{std::istreambuf_iterator<char>(stream), {}};
    const std::string begin = "<!-- fault matrix -->\n", end = "<!-- end of the fault matrix -->\n";
    const size_t from = text.find(begin), to = text.find(end);
    ASSERT_NE(from, std::string::npos) << page;
    ASSERT_NE(to, std::string::npos) << page;
    const std::string wanted = text.substr(0, from + begin.size()) + matrix() + text.substr(to);
    if (std::getenv("BONEMILL_WRITE_DOCS")) std::ofstream(page) << wanted;
    std::ifstream again(page);
    const std::string now{std::istreambuf_iterator<char>(again), {}};
    EXPECT_EQ(now, wanted) << "run this test with BONEMILL_WRITE_DOCS=1";
}

}  // namespace
}  // namespace bonemill
