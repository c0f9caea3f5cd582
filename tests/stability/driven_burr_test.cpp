// Asks what happens in contact to a burr that is driven: run-up, stall, pedal, pause, whirl, another tool.
#include "common/base/units.h"
#include "haptic_server/core/bone/bone_history.h"
#include "tests/stability/case_test.h"
#include "tests/stability/drive.h"
#include "tests/stability/energy_meter.h"
#include "tests/stability/hard_scenes.h"

namespace bonemill::test {
namespace {

constexpr double kHandPush = 3;  // N, of the hand's springs

// The round pit is half as wide again as the burr: friction drives the burr along its floor to the
// wall, and round.
const Eigen::Vector3d kPitFloor(2.52e-3, 2.48e-3, 1e-3);
VoxelVolume pitBone() {
    const auto pit = [](const Eigen::Vector3d& p) {
        const double off_axis = std::hypot(p.x() - kPitFloor.x(), p.y() - kPitFloor.y());
        return std::max(p.z() - kTop, std::min(1.5 * kBurrRadius - off_axis, p.z() - kPitFloor.z()));
    };
    return bodyVolume(boxOf({5e-3, 5e-3, 3.5e-3}), pit);
}
const Eigen::Quaterniond kLying = Eigen::Quaterniond::Identity();  // the burr's axis along y
const Eigen::Quaterniond kStanding = expRotation({M_PI / 2, 0, 0});

using Edit = std::function<void(FixedTickConfig&)>;

// The burr is in the pit, in the hand that pushes down; the pedal is up.
struct Pit {
    explicit Pit(const Variant& variant, const Eigen::Quaterniond& rotation = kLying, const Edit& edit = {},
                 const LoopConfig& config = {})
        : scene(pitBone(), burr(), variant, 1e-3, edit),
          history(scene.bone),
          start{kPitFloor + Eigen::Vector3d(0, 0, kBurrRadius + 0.1e-3), rotation},
          loop(config, scene, start, nullptr, &history),
          hand(config.hand) {
        press(kHandPush);
        hold(false);
    }
    void press(double force) {
        if (hand.stiffness == 0) return loop.plant.setBias({{0.1 * force, 0, -force}, {0, 0, 0}});
        loop.plant.setTarget(
            {start.position + Eigen::Vector3d(0.1 * force, 0, -force) / hand.stiffness, start.rotation});
    }
    void hold(bool pedal) { loop.stepper.holdButtons(pedal ? uint32_t(kButtonRemove) : 0); }

    Scene scene;
    BoneHistory history;
    Pose start;
    ClosedLoop loop;
    HandPlant hand;
};

// Returns the largest change of the force from tick to tick, N, over `seconds`.
double largestStep(Pit& pit, double seconds) {
    double worst = 0;
    Eigen::Vector3d before = pit.loop.stepper.wrenchOnHand().force;
    for (int n = 0; n < int(seconds * 1e3); ++n) {
        pit.loop.step();
        if (!pit.loop.stepper.isFinite()) return kNan;
        const Eigen::Vector3d force = pit.loop.stepper.wrenchOnHand().force;
        worst = worseOf(worst, (force - before).norm());
        before = force;
    }
    return worst;
}

// Where steps of the force are measured the wanted ones are left out.
void withoutVibration(FixedTickConfig& config) {
    config.effects.burr_vibration.reset();
}

double whirl(const Variant& variant, const Eigen::Quaterniond& rotation, const LoopConfig& config) {
    Pit pit(variant, rotation, {}, config);
    pit.hold(true);
    return forceBuzz(pit.loop, 1, 0.3);
}
double lyingInPit(const Variant& variant) {
    return whirl(variant, kLying, {});
}
double standingInPit(const Variant& variant) {
    return whirl(variant, kStanding, {});
}
double standingInPitNoHand(const Variant& variant) {
    LoopConfig config;
    config.hand = kNoHand;
    config.hand.angular_stiffness = 1;  // else the axis torque turns the handle for ever
    config.hand.angular_damping = 0.02;
    return whirl(variant, kStanding, config);
}

double runUpStep(const Variant& variant) {
    Pit pit(variant, kLying, withoutVibration);
    pit.loop.run(0.5);
    pit.hold(true);
    return largestStep(pit, 0.5);
}
double runUpRest(const Variant& variant) {
    Pit pit(variant);
    pit.loop.run(0.5);
    pit.hold(true);
    return forceBuzz(pit.loop, 1, 0.2);
}

// The motor is so weak that the full push stops it.
void weakMotor(FixedTickConfig& config) {
    if (config.effects.spindle)
        config.effects.spindle->max_torque = 0.5 * kCuttingFriction * kHandPush * kBurrRadius;
}
bool isStalled(const Pit& pit) {
    return pit.loop.stepper.record().effects.events & kEventSpindleStalled;
}
double stallAndRestart(const Variant& variant) {
    Pit pit(variant, kLying, weakMotor);
    pit.press(0.2 * kHandPush);
    pit.hold(true);
    pit.loop.run(1);
    if (isStalled(pit)) return kLost;
    pit.press(kHandPush);
    double worst = forceBuzz(pit.loop, 2, 0.3);
    if (!isStalled(pit)) return kLost;
    pit.press(0.2 * kHandPush);
    worst = worseOf(worst, forceBuzz(pit.loop, 2, 0.3));
    return isStalled(pit) ? kLost : worst;
}
double stallStep(const Variant& variant) {
    Pit pit(variant, kLying, [](FixedTickConfig& config) {
        weakMotor(config);
        withoutVibration(config);
    });
    pit.press(0.2 * kHandPush);
    pit.hold(true);
    pit.loop.run(1);
    pit.press(kHandPush);
    const double worst = largestStep(pit, 2);
    return isStalled(pit) ? worst : kLost;
}

// The pedal goes down and up. Returns the energy of hand and device in the last ten rounds over that
// in the first.
double pedalGrowth(const Variant& variant) {
    constexpr int kRounds = 20, kTicks = 100;
    Pit pit(variant);
    pit.loop.run(0.5);
    double first = 0, last = 0;
    for (int n = 0; n < 2 * kRounds * kTicks; ++n) {
        pit.hold(n / kTicks % 2 == 0);
        pit.loop.step();
        if (!pit.loop.stepper.isFinite()) return kNan;
        double& largest = n < kRounds * kTicks ? first : last;
        largest = std::max(largest, pit.loop.plant.energy());
    }
    return last / first;
}
double pedalRest(const Variant& variant) {
    Pit pit(variant);
    for (int n = 0; n < 20; ++n) {
        pit.hold(n % 2 == 0);
        pit.loop.run(0.05);
    }
    return forceBuzz(pit.loop, 1, 0.2);
}

// Milling is paused under the burr: it stops, and goes on.
double pauseRest(const Variant& variant) {
    Pit pit(variant);
    pit.hold(true);
    pit.loop.run(0.5);
    pit.history.pauseMilling(true);
    double worst = forceBuzz(pit.loop, 1, 0.2);
    if (std::abs(pit.loop.stepper.record().effects.spin_speed) > 1) return kLost;
    pit.history.pauseMilling(false);
    worst = worseOf(worst, forceBuzz(pit.loop, 1, 0.2));
    return pit.loop.stepper.record().effects.spin_speed > kSpinSpeed / 2 ? worst : kLost;
}
double pauseStep(const Variant& variant) {
    Pit pit(variant, kLying, withoutVibration);
    pit.hold(true);
    pit.loop.run(0.5);
    pit.history.pauseMilling(true);
    const double stopping = largestStep(pit, 0.3);
    pit.history.pauseMilling(false);
    return worseOf(stopping, largestStep(pit, 0.3));
}

// The burr is pressed against floor and wall, drawn round in the pit and let go. Returns the energy that the
// hand got beyond what the motor gave, µJ.
double beyondTheMotor(const Variant& variant, int way) {
    Scene scene(pitBone(), burr(), variant);
    Stepper stepper(scene);
    AlgorithmEnergy meter;
    double motor = 0, worst = 0;
    const Eigen::Vector3d middle = kPitFloor + Eigen::Vector3d(0, 0, kBurrRadius);
    constexpr int kRound = 1500, kPressed = 3 * kRound;
    for (int n = 0; n < 4 * kRound; ++n) {
        const double angle = way * 2 * M_PI * n / kRound, out = n < kPressed ? 0.7e-3 : 0;
        const double down = n < kPressed ? 0.4e-3 * std::min(1.0, n / 300.0) : -0.1e-3;
        const Eigen::Vector3d shift(out * std::cos(angle), out * std::sin(angle), -down);
        const Pose device{middle + shift, kStanding};
        stepper.step(device);
        if (!stepper.isFinite()) return kNan;
        meter.add(device, stepper.wrenchOnHand());
        const EffectRecord& record = stepper.record().effects;
        motor += double(record.axis_torque) * std::abs(double(record.spin_speed)) * scene.config.dt;
        worst = std::max(worst, -(meter.energy() + motor) * kPerMicro);
    }
    return motor > 1e-3 ? worst : kLost;
}
double beyondTheMotor(const Variant& variant) {
    return worseOf(beyondTheMotor(variant, 1), beyondTheMotor(variant, -1));
}

// The burr is drilled into full bone by a hand that goes ahead. Returns the largest step of the force.
double drillingStep(const Variant& variant) {
    Pit pit(variant, kLying, withoutVibration);
    pit.hold(true);
    pit.loop.run(0.2);
    double worst = 0;
    for (int n = 0; n < 20; ++n) {
        pit.press(kHandPush * (1 + 0.1 * n));
        worst = worseOf(worst, largestStep(pit, 0.1));
    }
    return pit.history.missingVoxels() > 500 ? worst : kLost;
}

// A pull that comes at once, without a spindle that runs up, comes within smoothing_time.
constexpr double kStep = 0.3;  // N per tick

const Names kPulling{"cutting_force", "all_felt"}, kDriven{"spindle", "all_felt"},
    kStepping{"spindle", "cutting_force", "surface_friction", "all_felt"};

const std::vector<StabilityCase> kDrivenBurrCases{
    {"spinning_burr_lying_in_pit", "N_rms", 0.05, lyingInPit, {}, feltEffects(), true},
    {"spinning_burr_standing_in_pit", "N_rms", 0.05, standingInPit, {}, feltEffects(), true},
    {"spinning_burr_in_pit_no_hand", "N_rms", 0.05, standingInPitNoHand, {}, kPulling, true},
    {"run_up_in_contact_step", "N_per_tick", kStep, runUpStep, {}, kStepping, true},
    {"run_up_in_contact_rest", "N_rms", 0.05, runUpRest, {}, feltEffects(), true},
    {"stall_and_restart_rest", "N_rms", 0.05, stallAndRestart, {}, kDriven, true},
    {"stall_step", "N_per_tick", kStep, stallStep, {}, kDriven, true},
    {"pedal_on_and_off_growth", "ratio", 1.05, pedalGrowth, {}, feltEffects(), true},
    {"pedal_on_and_off_rest", "N_rms", 0.05, pedalRest, {}, feltEffects(), true},
    {"pause_in_contact_rest", "N_rms", 0.05, pauseRest, {}, feltEffects(), true},
    {"pause_in_contact_step", "N_per_tick", kStep, pauseStep, {}, kStepping, true},
    {"drilling_step", "N_per_tick", kStep, drillingStep, {}, {"energy_removal", "all_effects"}, true},
    {"energy_beyond_the_motor", "uJ_gained", 1, beyondTheMotor, {}, kPulling, true},
};
BONEMILL_STABILITY_CASES(DrivenBurr, kDrivenBurrCases);

}  // namespace
}  // namespace bonemill::test
