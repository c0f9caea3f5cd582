// At the maximum push the tool stays on its side of the bone and the force within its limit.
#include "common/base/units.h"
#include "tests/stability/case_test.h"
#include "tests/stability/drive.h"
#include "tests/stability/hard_scenes.h"

namespace bonemill::test {
namespace {

constexpr double kPushSpeed = 0.1;    // m/s
constexpr double kFastSpeed = 2;      // m/s: 2 mm per tick, 16 times the wall
constexpr double kPushDepth = 20e-3;  // m: far beyond what saturates any coupling
constexpr int kHoldTicks = 300;

// Pushes the device straight down by kPushDepth and holds it there.
template <class EachTick>
void pushDown(Stepper& stepper, const Pose& start, EachTick&& each_tick, double speed = kPushSpeed) {
    const int ticks = int(kPushDepth / speed * 1000);
    for (int n = 0; n < ticks + kHoldTicks; ++n) {
        Pose device = start;
        device.position.z() -= kPushDepth * std::min(1.0, double(n) / ticks);
        stepper.step(device);
        each_tick();
    }
}

// Returns how far the burr's centre got below `height`, mm; negative says that it never did.
double centreBelow(Scene& scene, const Pose& start, double height, double speed = kPushSpeed) {
    Stepper stepper(scene);
    double lowest = 1;
    const auto note = [&] {
        const double z = stepper.isFinite() ? stepper.spo().position.z() : -1;
        lowest = std::min(lowest, z);
    };
    pushDown(stepper, start, note, speed);
    return (height - lowest) * kPerMillimetre;
}

double throughWall(const Variant& variant, double speed) {
    const DistanceFunction one_voxel = wall(kMiddle, Eigen::Vector3d::UnitZ(), kVoxel);
    Scene scene(bodyVolume(boxOf(Eigen::Vector3d::Constant(5e-3)), one_voxel), burr(), variant);
    return centreBelow(scene, abovePlane(0.5e-3), kTop, speed);
}
double oneVoxelWall(const Variant& variant) {
    return throughWall(variant, kPushSpeed);
}
double oneVoxelWallFast(const Variant& variant) {
    return throughWall(variant, kFastSpeed);
}

// The pin is thinner than what the tool may move in one tick: only the sweep can see the wall. With
// material_stiffness it lies on soft bone alone, which carries some 50 N of it and is pulled at with more
// (docs/explanation/stability.md); from 45 N instead of 50 on it holds.
double pinThroughWall(const Variant& variant) {
    constexpr double kPin = 0.2e-3;
    const DistanceFunction one_voxel = wall(kMiddle, Eigen::Vector3d::UnitZ(), kVoxel);
    Scene scene(bodyVolume(boxOf(Eigen::Vector3d::Constant(5e-3)), one_voxel), pegTool(kPin, 1.5e-3), variant,
                1e-3, [](FixedTickConfig& config) { config.tool.burr.radius = kPin; });
    return centreBelow(scene, upright(kMiddle + Eigen::Vector3d(0, 0, kPin + 1.37e-3)), kTop, kFastSpeed);
}

double deepPush(const Variant& variant) {
    Scene scene(planeBone(), burr(), variant);
    return centreBelow(scene, abovePlane(0.5e-3), kTop);
}

double deepPushForce(const Variant& variant) {
    Scene scene(planeBone(), burr(), variant);
    Stepper stepper(scene);
    double worst = 0;
    pushDown(stepper, abovePlane(0.5e-3), [&] {
        const double force = stepper.isFinite() ? stepper.wrenchOnHand().force.norm() : kNan;
        worst = worseOf(worst, force);
    });
    return worst / scene.handSide().limits.max_force;
}

// The tool is on the right side if under full push the force points out of the bone.
double deepPushDirection(const Variant& variant) {
    Scene scene(planeBone(), burr(), variant);
    Stepper stepper(scene);
    pushDown(stepper, abovePlane(0.5e-3), [] {});
    const Eigen::Vector3d force = stepper.wrenchOnHand().force;
    if (!(force.norm() > 1e-6)) return 180;  // nothing holds it any more
    return std::acos(force.z() / force.norm()) / kDegree;
}

const std::vector<StabilityCase> kPenetrationCases{
    {"one_voxel_wall",
     "mm_past_wall",
     0,
     oneVoxelWall,
     {"thesis_2012", "vps"},
     feltEffectsBut({"cutting_force"}) + everyDevice() + everyLaw()},
    {"one_voxel_wall_fast_hand",
     "mm_past_wall",
     0,
     oneVoxelWallFast,
     {"thesis_2012", "vps"},
     feltEffectsBut({"cutting_force"}) + everyLaw()},
    {"pin_through_wall_fast_hand",
     "mm_past_wall",
     0,
     pinThroughWall,
     {"thesis_2012", "vps", "penalty_sdf"},
     feltEffectsBut({"material_stiffness"}) + everyLaw()},
    {"deep_push_side",
     "mm_past_surface",
     0,
     deepPush,
     {"thesis_2012", "vps"},
     feltEffectsBut({"cutting_force"}) + everyDevice() + everyLaw()},
    {"deep_push_force", "of_max_force", 1 + 1e-9, deepPushForce, {}, feltEffects() + everyDevice()},
    {"deep_push_direction",
     "degrees",
     10,
     deepPushDirection,
     {"thesis_2012", "vps"},
     everyDevice() + everyLaw()},
};
BONEMILL_STABILITY_CASES(Penetration, kPenetrationCases);

}  // namespace
}  // namespace bonemill::test
