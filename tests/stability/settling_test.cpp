// The closed loop at rest under load has no limit cycle and no buzz.
#include "common/base/units.h"
#include "tests/stability/case_test.h"
#include "tests/stability/drive.h"
#include "tests/stability/hard_scenes.h"

namespace bonemill::test {
namespace {

constexpr double kSettle = 0.5, kWatch = 0.5;  // s

double forceResidual(ClosedLoop& loop) {
    return forceBuzz(loop, kSettle, kWatch);
}

double pegHeld(const Variant& variant) {
    Scene scene(holeBone(), peg(), variant);
    ClosedLoop loop({}, scene, upright(kHoleMiddle));
    loop.plant.setTarget({kHoleMiddle + Eigen::Vector3d(2e-3, 0, 1e-3), expRotation({0.07, 0, 0.1})});
    return forceResidual(loop);
}

double pegFree(const Variant& variant) {
    Scene scene(holeBone(), peg(), variant);
    LoopConfig config;
    config.hand = kNoHand;
    ClosedLoop loop(config, scene, upright(kHoleMiddle));
    loop.plant.setBias({{1, 0, 0.5}, {0.0003, 0, 0.0005}});
    return forceResidual(loop);
}

constexpr double kGrooveAngles_deg[] = {10, 20, 30, 45, 60};

// They are tall enough for the burr to wedge between the walls, however steep.
struct Groove {
    explicit Groove(double angle_deg)
        : wedged(kBurrRadius / std::sin(degrees(angle_deg) / 2)),
          volume(
              bodyVolume(boxOf({4e-3, 4e-3, edge.z() + wedged + 1.5e-3}), groove(edge, degrees(angle_deg)))),
          start(edge + Eigen::Vector3d(0, 0, wedged + 0.3e-3)),
          target(upright(start + Eigen::Vector3d(0.5e-3, 0, -5e-3))) {}

    Eigen::Vector3d edge{2.02e-3, 2e-3, 0.6e-3};
    double wedged;  // burr's centre above the edge, m
    VoxelVolume volume;
    Eigen::Vector3d start;
    Pose target;
};

double grooveWorst(const Variant& variant) {
    double worst = 0;
    for (const double angle : kGrooveAngles_deg) {
        Groove groove(angle);
        Scene scene(std::move(groove.volume), burr(), variant);
        ClosedLoop loop({}, scene, upright(groove.start));
        loop.plant.setTarget(groove.target);
        const double figure = forceResidual(loop);
        worst = worseOf(worst, figure);
    }
    return worst;
}

// Four iterations a tick are compared with as many as there can be: returns how far the two tools come apart
// at most from tick `from` on, pressed into the groove by the same device, µm. thesis_2012 always takes one.
double apartByIterations(const Variant& variant, int from) {
    constexpr int kFour = 4, kTicks = 500, kPressTicks = 300;
    double worst = 0;
    for (const double angle : kGrooveAngles_deg) {
        const Groove groove(angle);
        const auto limitTo = [](int iterations) {
            return [=](FixedTickConfig& config) {
                config.accuracy.iterations = iterations;
                // There is room for all; else the way into the groove decides which patch is sampled
                // how finely.
                config.accuracy.most_samples = presetSettings(Preset::kExact).most_samples;
            };
        };
        Scene scene(groove.volume, burr(), variant, 1e-3, limitTo(kFour));
        Scene reference_scene(groove.volume, burr(), variant, 1e-3,
                              limitTo(AccuracySettings::kMaxIterations));
        Stepper stepper(scene), reference(reference_scene);
        for (int n = 0; n < kTicks; ++n) {
            const double s = std::min(1.0, double(n) / kPressTicks);
            const Pose device = upright(groove.start + s * Eigen::Vector3d(0.5e-3, 0, -3e-3));
            if (stepper.step(device).iterations > kFour) return kNan;
            reference.step(device);
            const double apart = (stepper.spo().position - reference.spo().position).norm() * kPerMicrometre;
            if (n >= from) worst = worseOf(worst, apart);
        }
        if (reference.record().contacts == 0) return kLost;
    }
    return worst;
}
double fourIterationsPressing(const Variant& variant) {
    return apartByIterations(variant, 0);
}
double fourIterationsAtRest(const Variant& variant) {
    return apartByIterations(variant, 400);
}

double coarseEncodersAtRest(const Variant& variant) {
    Scene scene(planeBone(), burr(), variant);
    LoopConfig config;
    config.device.encoder_step = 20e-6;
    config.device.encoder_angle = degrees(0.05);
    ClosedLoop loop(config, scene, abovePlane(0.2e-3));
    loop.plant.setTarget({abovePlane(-5e-3).position, expRotation({0.05, 0.03, 0})});
    return forceResidual(loop);
}

// The worst encoder flicker toggles the reading by one step every tick on a device that stands still.
double flickeringEncoder(const Variant& variant) {
    Scene scene(planeBone(), burr(), variant);
    Stepper stepper(scene);
    const double step = 20e-6;
    for (int n = 0; n < 300; ++n) stepper.step(abovePlane(0.1e-3 - 1e-6 * n));
    double low = 1e9, high = -1e9;
    for (int n = 0; n < 500; ++n) {
        stepper.step(abovePlane(-0.2e-3 + step * (n % 2)));
        if (n < 100) continue;
        low = std::min(low, stepper.wrenchOnHand().force.z());
        high = std::max(high, stepper.wrenchOnHand().force.z());
    }
    return (high - low) / (couplingFigures(scene.config).quick_stiffness * step);
}

const std::vector<StabilityCase> kSettlingCases{
    {"peg_in_hole_held", "N_rms", 0.05, pegHeld, {}, feltEffects() + everyDevice()},
    {"peg_in_hole_no_hand", "N_rms", 0.05, pegFree, {}, feltEffects() + everyDevice()},
    {"wedge_10_to_60_degrees",
     "N_rms",
     0.05,
     grooveWorst,
     {"thesis_2012", "vps"},
     feltEffects() + everyDevice() + everyLaw()},
    {"wedge_four_iterations_pressing",
     "um_from_converged",
     kVoxel / 4 * kPerMicrometre,
     fourIterationsPressing,
     {}},
    {"wedge_four_iterations_at_rest", "um_from_converged", 2, fourIterationsAtRest, {}},
    {"coarse_encoders_at_rest",
     "N_rms",
     0.05,
     coarseEncodersAtRest,
     {},
     feltEffectsBut({"cutting_force"}) + everyDevice()},
    // A flicker of one step may be felt as the coupling's quick stiffness times the step, and no more.
    {"encoder_flicker", "of_quick_step", 1, flickeringEncoder, {}, feltEffectsBut({"burr_vibration"})},
};
BONEMILL_STABILITY_CASES(Settling, kSettlingCases);

}  // namespace
}  // namespace bonemill::test
