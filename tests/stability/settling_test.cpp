// Closed loop at rest under load: no limit cycle, no buzz.
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

// Tall enough for the burr to wedge between the walls, however steep.
double grooveWorst(const Variant& variant) {
    double worst = 0;
    for (const double angle : {10, 20, 30, 45, 60}) {
        const Eigen::Vector3d edge(2.02e-3, 2e-3, 0.6e-3);
        const double wedged = kBurrRadius / std::sin(degrees(angle) / 2);  // centre above the edge
        const VolumeGeometry geometry = boxOf({4e-3, 4e-3, edge.z() + wedged + 1.5e-3});
        Scene scene(bodyVolume(geometry, groove(edge, degrees(angle))), burr(), variant);
        const Eigen::Vector3d start = edge + Eigen::Vector3d(0, 0, wedged + 0.3e-3);
        ClosedLoop loop({}, scene, upright(start));
        loop.plant.setTarget(upright(start + Eigen::Vector3d(0.5e-3, 0, -5e-3)));
        const double figure = forceResidual(loop);
        if (!(figure <= worst)) worst = figure;
    }
    return worst;
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

// Worst encoder flicker: the reading toggles by one step every tick on a device that stands still.
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

const std::vector<StabilityCase> kCases{
    {"peg_in_hole_held", "N_rms", 0.05, pegHeld, {}},
    {"peg_in_hole_no_hand", "N_rms", 0.05, pegFree, {}},
    {"wedge_10_to_60_degrees", "N_rms", 0.05, grooveWorst, {"thesis_2012"}},
    {"coarse_encoders_at_rest", "N_rms", 0.05, coarseEncodersAtRest, {}},
    // A flicker of one step may be felt as the coupling's quick stiffness times the step, and no more.
    {"encoder_flicker", "of_quick_step", 1, flickeringEncoder, {}},
};
BONEMILL_STABILITY_CASES(Settling, kCases);

}  // namespace
}  // namespace bonemill::test
