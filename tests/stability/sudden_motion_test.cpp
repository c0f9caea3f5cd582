// Makes what no hand does but a link, a reset or a dropped sample can: jumps, half turns, starts inside bone.
#include "tests/stability/case_test.h"
#include "tests/stability/drive.h"
#include "tests/stability/hard_scenes.h"

namespace bonemill::test {
namespace {

// Returns the worst of force, torque and the tool's step over their limits, while the device jumps
// there and back.
double deviceJump(const Variant& variant) {
    Scene scene(planeBone(), burr(), variant);
    const HandLimitsConfig& most = scene.config.hand;
    const CouplingFigures figures = couplingFigures(scene.config);
    Stepper stepper(scene);
    const Pose start = abovePlane(-0.2e-3);
    const Pose far = {start.position + 50e-3 * Eigen::Vector3d(1, 1, -1).normalized(),
                      expRotation(M_PI * Eigen::Vector3d(1, 2, 2).normalized())};
    double worst = 0;
    Pose last = start;
    for (int n = 0; n < 600; ++n) {
        stepper.step(n < 100 || n >= 400 ? start : far);
        const Wrench& wrench = stepper.wrenchOnHand();
        const double step = (stepper.spo().position - last.position).norm();
        const double figure =
            std::max({wrench.force.norm() / most.max_force, wrench.torque.norm() / most.max_torque,
                      step / (figures.max_speed * scene.config.dt)});
        if (!stepper.isFinite()) return kNan;
        worst = worseOf(worst, figure);
        last = stepper.spo();
    }
    return worst;
}

// The device turns away from the tool as fast as is believed of a hand. Then it is 0.1° before and 0.1°
// beyond half a turn from the tool, in turn. Returns the change of torque, % of the limit.
double nearAntipodal(const Variant& variant) {
    Scene scene(VoxelVolume(boxOf(Eigen::Vector3d::Constant(1e-3)), kTestIso), burr(), variant);
    const Eigen::Vector3d axis = Eigen::Vector3d(1, -2, 2).normalized();
    Stepper stepper(scene);
    stepper.step({});
    double worst = 0;
    Eigen::Vector3d before = Eigen::Vector3d::Zero();
    const auto turnAway = [&](double angle) {
        stepper.step({stepper.spo().position, expRotation(angle * axis) * stepper.spo().rotation});
    };
    for (double angle = 0; angle < degrees(179.9); angle += 0.8 * HandPlace::kMostSpin * scene.config.dt)
        turnAway(angle);
    for (int n = 0; n < 40; ++n) {
        turnAway(degrees(180 + (n % 2 ? 0.1 : -0.1)));
        if (!stepper.isFinite()) return kNan;
        const Eigen::Vector3d torque = stepper.wrenchOnHand().torque;
        if (n > 0) worst = worseOf(worst, (torque - before).norm());
        before = torque;
    }
    return 100 * worst / scene.config.hand.max_torque;
}

double startInside(const Variant& variant, double depth, double (*figure_of)(ClosedLoop&, const Scene&)) {
    Scene scene(planeBone(), burr(), variant);
    ClosedLoop loop({}, scene, abovePlane(-depth));
    return figure_of(loop, scene);
}

// The tool leaves the bone no faster than it may move: the force fades in.
double fadeIn(ClosedLoop& loop, const Scene& scene) {
    const CouplingFigures coupling = couplingFigures(scene.config);
    double worst = 0;
    Eigen::Vector3d before = Eigen::Vector3d::Zero();
    for (int n = 0; n < 300; ++n) {
        loop.step();
        const Eigen::Vector3d force = loop.stepper.wrenchOnHand().force;
        if (!loop.stepper.isFinite()) return kNan;
        worst = worseOf(worst, (force - before).norm());
        before = force;
    }
    return worst / (coupling.translation_stiffness * coupling.max_speed * scene.config.dt);
}

double settled(ClosedLoop& loop, const Scene&) {
    loop.run(0.5);
    const Residual r = residual(loop, 0.5);
    return r.is_finite ? r.rms : kNan;
}

double halfInsideFadeIn(const Variant& v) {
    return startInside(v, kBurrRadius / 2, fadeIn);
}
double halfInsideSettles(const Variant& v) {
    return startInside(v, kBurrRadius / 2, settled);
}
double buriedFadeIn(const Variant& v) {
    return startInside(v, 2.2 * kBurrRadius, fadeIn);
}
double buriedSettles(const Variant& v) {
    return startInside(v, 2.2 * kBurrRadius, settled);
}

const std::vector<StabilityCase> kSuddenMotionCases{
    {"device_jump_50mm_180deg", "of_limit", 1 + 1e-9, deviceJump, {}, feltEffects()},
    {"near_antipodal", "percent_of_max", 1, nearAntipodal, {"thesis_2012"}, feltEffects()},
    {"start_half_inside_fades_in", "of_speed_limit", 1.1, halfInsideFadeIn, {}, feltEffects()},
    {"start_half_inside_settles", "N_rms", 0.05, halfInsideSettles, {}, feltEffects()},
    {"start_buried_fades_in", "of_speed_limit", 1.1, buriedFadeIn, {}},
    {"start_buried_settles", "N_rms", 0.05, buriedSettles, {}},
};
BONEMILL_STABILITY_CASES(SuddenMotion, kSuddenMotionCases);

}  // namespace
}  // namespace bonemill::test
