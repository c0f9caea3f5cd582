// What only a law of six degrees of freedom can do.
#include "tests/stability/case_test.h"
#include "tests/stability/drive.h"
#include "tests/stability/hard_scenes.h"

namespace bonemill::test {
namespace {

// In a hole with half a voxel of clearance the hand turns the peg by 5°; the wall lets it turn by less than
// 2°. The figure is the torque that the coupling has for the rest over what is felt: without torque it has no
// bound.
double leaningPegTorque(const Variant& variant) {
    constexpr double kTurn = 5;  // degrees
    Scene scene(holeBone(), peg(), variant);
    Stepper stepper(scene);
    for (int n = 0; n < 400; ++n)
        stepper.step({kHoleMiddle, expRotation({0, 0, degrees(kTurn) * std::min(1.0, n / 200.0)})});
    if (!stepper.isFinite()) return kNan;
    const double expected = couplingFigures(scene.config).rotation_stiffness * degrees(kTurn - 2);
    return expected / stepper.wrenchOnHand().torque.norm();
}

const std::vector<StabilityCase> kLawCases{
    {"leaning_peg_torque",
     "expected_over_felt",
     1.25,
     leaningPegTorque,
     {"thesis_2012", "proxy_3dof", "vps", "penalty_sdf"},
     everyLaw()},
};
BONEMILL_STABILITY_CASES(Laws, kLawCases);

}  // namespace
}  // namespace bonemill::test
