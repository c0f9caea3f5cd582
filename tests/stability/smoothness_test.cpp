// The force over a smooth motion stays smooth while the tool slides over the surface, or mills it
// away under load.
#include "tests/stability/case_test.h"
#include "tests/stability/drive.h"
#include "tests/stability/hard_scenes.h"

namespace bonemill::test {
namespace {

// Slides the device over a tilted plane at constant depth. Returns the spread of the normal force over
// its mean, %.
double grazingSlide(const Variant& variant) {
    const Eigen::Vector3d normal = Eigen::Vector3d(0.2, 0.1, 1).normalized();
    const Eigen::Vector3d middle(4e-3, 2.5e-3, 2e-3);
    Scene scene(bodyVolume(boxOf({8e-3, 5e-3, 4e-3}), halfSpace(middle, normal)), burr(), variant);
    const Eigen::Vector3d along = normal.cross(Eigen::Vector3d(-0.3, 1, 0)).normalized();
    const double depth = 0.1e-3, speed = 10e-3, reach = 2.3e-3;
    Stepper stepper(scene);
    std::vector<double> force;
    const int ticks = int(2 * reach / speed * 1000);
    for (int n = 0; n < ticks; ++n) {
        const double s = -reach + 2 * reach * n / ticks;
        stepper.step(upright(middle + s * along + (kBurrRadius - depth) * normal));
        if (n >= ticks / 4) force.push_back(stepper.wrenchOnHand().force.dot(normal));
    }
    double mean = 0, square = 0;
    for (const double f : force) mean += f / double(force.size());
    for (const double f : force) square += (f - mean) * (f - mean) / double(force.size());
    return 100 * std::sqrt(square) / mean;
}

// Presses, then mills. Returns the largest change of force from tick to tick, N.
double removalUnderLoad(const Variant& variant) {
    Scene scene(planeBone(), burr(), variant);
    Stepper stepper(scene);
    for (int n = 0; n < 600; ++n) stepper.step(abovePlane(0.1e-3 - std::min(n, 400) * 1e-6));
    double worst = 0;
    Eigen::Vector3d before = stepper.wrenchOnHand().force;
    if (!(before.z() > 0.1)) return kNan;  // it was never under load
    for (int n = 0; n < 300; ++n) {
        stepper.step(abovePlane(-0.3e-3), kButtonRemove);
        const double change = (stepper.wrenchOnHand().force - before).norm();
        worst = worseOf(worst, change);
        before = stepper.wrenchOnHand().force;
    }
    return worst;
}

// Removal by time works through the burr's diameter in 20 ms: the tool gains 0.1 mm per tick, with which the
// coupling alone would fall by 0.3 N and, with its relaxing spring, 0.6 N.
constexpr double kMaxStep = 0.3;  // N per tick

const std::vector<StabilityCase> kSmoothnessCases{
    {"grazing_slide",
     "percent",
     2,
     grazingSlide,
     {"thesis_2012", "vps", "penalty_sdf"},
     feltEffectsBut({"burr_vibration", "material_stiffness", "virtual_fixture"}) + everyDevice() +
         everyLaw()},
    {"removal_under_load", "N_per_tick", kMaxStep, removalUnderLoad, {}, everyLaw()},
};
BONEMILL_STABILITY_CASES(Smoothness, kSmoothnessCases);

}  // namespace
}  // namespace bonemill::test
