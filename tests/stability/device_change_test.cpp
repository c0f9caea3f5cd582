// Another device is plugged in while the hand presses, and the first one again.
#include "tests/stability/case_test.h"
#include "tests/stability/drive.h"
#include "tests/stability/hard_scenes.h"

namespace bonemill::test {
namespace {

constexpr double kTypicalForce = 40;  // N

// It is softer than any coupling here, and gives less than the hand presses with.
constexpr DeviceCapabilities kSoftArm{.name = "soft arm",
                                      .kind = uint32_t(DeviceKind::kUnknown),
                                      .abilities = kAbilityForce,
                                      .max_force = 1.5,
                                      .max_torque = 0,
                                      .max_stiffness = 1500,
                                      .max_rotation_stiffness = 0,
                                      .workspace_radius = 0.08};
constexpr DeviceCapabilities kStrong{.name = "strong",
                                     .kind = uint32_t(DeviceKind::kUnknown),
                                     .abilities = kAbilityForce | kAbilityTorque,
                                     .max_force = kTypicalForce,
                                     .max_torque = 1,
                                     .max_stiffness = 0,
                                     .max_rotation_stiffness = 0,
                                     .workspace_radius = 0.08};

// The typical hand has come to rest where it presses the burr with some newtons on the plane.
struct PluggedBench {
    explicit PluggedBench(const Variant& variant)
        : scene(planeBone(), burr(), variant), loop({}, scene, abovePlane(0.2e-3)) {
        loop.plant.setTarget(upright(kMiddle + Eigen::Vector3d(0.1e-3, 0, kBurrRadius - 5e-3)));
        loop.run(0.5);
    }
    Scene scene;
    ClosedLoop loop;
};

// Returns the change of the force from tick to tick over what the rate and the hand's own motion allow.
double jumpAtAChange(const Variant& variant) {
    PluggedBench bench(variant);
    if (!(bench.loop.stepper.wrenchOnHand().force.norm() > 2)) return kNan;  // it must be more than the arm's
    const double stiffness = bench.scene.handSide().spring.stiffness;
    double worst = 0;
    Eigen::Vector3d force = bench.loop.stepper.wrenchOnHand().force;
    Eigen::Vector3d hand = bench.loop.plant.measured().position;
    for (const DeviceCapabilities* device : {&kSoftArm, &kStrong}) {
        bench.loop.stepper.plugIn(device);
        for (int n = 0; n < 300; ++n) {
            const Eigen::Vector3d hand_now = bench.loop.plant.measured().position;
            bench.loop.step();
            if (!bench.loop.stepper.isFinite()) return kNan;
            const Eigen::Vector3d force_now = bench.loop.stepper.wrenchOnHand().force;
            const double allowed =
                HandLimits::kForceRate * bench.scene.config.dt + stiffness * (hand_now - hand).norm();
            worst = worseOf(worst, (force_now - force).norm() / allowed);
            force = force_now, hand = hand_now;
        }
    }
    return worst;
}

// Returns how much the loop buzzes with each device, once it has come to rest.
double restAfterAChange(const Variant& variant) {
    PluggedBench bench(variant);
    double worst = 0;
    for (const DeviceCapabilities* device : {&kSoftArm, &kStrong}) {
        bench.loop.stepper.plugIn(device);
        worst = worseOf(worst, forceBuzz(bench.loop, 0.5, 0.2));
    }
    return worst;
}

const std::vector<StabilityCase> kDeviceChangeCases{
    {"device_change_jump_on_plane", "of_allowed", 1 + 1e-6, jumpAtAChange, {}},
    {"device_change_rest_on_plane", "N_rms", 0.05, restAfterAChange, {}},
};
BONEMILL_STABILITY_CASES(DeviceChange, kDeviceChangeCases);

}  // namespace
}  // namespace bonemill::test
