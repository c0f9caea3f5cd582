// The tool is changed for a larger or smaller one while it presses on the bone.
#include "common/base/units.h"
#include "tests/stability/case_test.h"
#include "tests/stability/drive.h"
#include "tests/stability/hard_scenes.h"

namespace bonemill::test {
namespace {

constexpr double kSmall = 0.5e-3, kLarge = 1.5e-3;  // burr radius, m
constexpr size_t kSmallTool = 0, kLargeTool = 1;

TestTool ballTool(double radius) {
    return {sphereTool(radius, kVoxel), {SphereShape{Eigen::Vector3d::Zero(), radius}}, radius};
}
ToolModel modelOf(TestTool tool) {
    return {std::move(tool.grid), tool.shapes, tool.thinnest_radius};
}

// The closed loop has a typical hand, which has come to rest where it pushes the small burr.
struct Bench {
    Bench(VoxelVolume volume, const Variant& variant, const Eigen::Vector3d& start,
          const Eigen::Vector3d& target)
        : scene(std::move(volume), ballTool(kSmall), variant),
          small(modelOf(ballTool(kSmall))),
          large(modelOf(ballTool(kLarge))),
          tools({{&small, burrOf(kSmall), 10}, {&large, burrOf(kLarge), 30}}),
          loop({}, scene, upright(start), &tools) {
        loop.plant.setTarget(upright(target));
        loop.run(0.5);
    }
    void change(size_t tool) { tools.choose(tool); }
    Burr burrOf(double radius) const {
        Burr burr = scene.config.tool.burr;
        burr.radius = radius;
        return burr;
    }

    Scene scene;
    ToolModel small, large;
    ToolSwitch tools;
    ClosedLoop loop;
};

// On the plane, the hand pushes straight down and a little sideways.
Bench onPlane(const Variant& variant) {
    return {planeBone(), variant, kMiddle + Eigen::Vector3d(0, 0, kSmall + 0.1e-3),
            kMiddle + Eigen::Vector3d(0.1e-3, 0, kSmall - 4e-3)};
}
// This is at the bottom of a hole that is just wider than the small burr: the large one is in bone
// all around.
Bench inHole(const Variant& variant) {
    const Eigen::Vector3d bottom(3.05e-3, 2.95e-3, 4.5e-3);
    const auto drilled = [=](const Eigen::Vector3d& p) {
        const double up = std::max(0.0, p.z() - bottom.z());
        const double to_axis = (p - bottom - Eigen::Vector3d(0, 0, up)).norm();
        return std::max(p.z() - 6.5e-3, kSmall + kVoxel / 2 - to_axis);
    };
    return {bodyVolume(boxOf({6e-3, 6e-3, 7.5e-3}), drilled), variant, bottom,
            bottom - Eigen::Vector3d(0, 0, 3e-3)};
}

// Returns the change of the force from tick to tick over what the rate and the hand's own motion allow.
double largestJump(Bench bench, uint32_t buttons) {
    const double stiffness = std::max(couplingFigures(bench.scene.config).quick_stiffness,
                                      bench.scene.config.gradient.coupling.translation_stiffness *
                                          (1 + bench.scene.config.gradient.coupling.relaxing_share));
    double worst = 0;
    Eigen::Vector3d force = bench.loop.stepper.wrenchOnHand().force;
    Eigen::Vector3d hand = bench.loop.plant.measured().position;
    for (const size_t tool : {kLargeTool, kSmallTool}) {
        bench.change(tool);
        for (int n = 0; n < 300; ++n) {
            const Eigen::Vector3d hand_now = bench.loop.plant.measured().position;
            bench.loop.step(buttons);
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

double restAfter(Bench bench, std::initializer_list<size_t> tools) {
    double worst = 0;
    for (const size_t tool : tools) {
        bench.change(tool);
        worst = worseOf(worst, forceBuzz(bench.loop, 0.5, 0.2));
    }
    return worst;
}

double jumpOnPlane(const Variant& variant) {
    return largestJump(onPlane(variant), 0);
}
double jumpInHole(const Variant& variant) {
    return largestJump(inHole(variant), 0);
}
double jumpWhileMilling(const Variant& variant) {
    return largestJump(onPlane(variant), kButtonRemove);
}
double restOnPlane(const Variant& variant) {
    return restAfter(onPlane(variant), {kLargeTool, kSmallTool});
}
double restInHole(const Variant& variant) {
    return restAfter(inHole(variant), {kLargeTool, kSmallTool});
}

// Returns how far the large burr stays in the bone on which it rests, of a voxel.
double leftInPlane(const Variant& variant) {
    Bench bench = onPlane(variant);
    bench.change(kLargeTool);
    bench.loop.run(0.5);
    if (!bench.loop.stepper.isFinite()) return kNan;
    return (kTop + kLarge - bench.loop.stepper.spo().position.z()) / kVoxel;
}

// The hand draws out the large burr, which became it in the hole. Returns the ms until it is 5 mm up
// and touches nothing.
double drawnOut(const Variant& variant) {
    constexpr double kUp = 5e-3;
    Bench bench = inHole(variant);
    const double bottom = bench.loop.stepper.spo().position.z();
    bench.change(kLargeTool);
    bench.loop.run(0.3);
    bench.loop.plant.setTarget(upright({3.05e-3, 2.95e-3, bottom + 1.5 * kUp}));
    for (int n = 0; n < 1000; ++n) {
        bench.loop.step();
        if (!bench.loop.stepper.isFinite()) return kNan;
        if (bench.loop.stepper.spo().position.z() > bottom + kUp && bench.loop.stepper.record().contacts == 0)
            return n * bench.scene.config.dt * kPerMillisecond;
    }
    return kLost;
}

// Returns the hand's highest speed, mm/s, while the larger burr lifts it.
double liftSpeed(const Variant& variant) {
    Bench bench = onPlane(variant);
    bench.change(kLargeTool);
    double worst = 0;
    for (int n = 0; n < 300; ++n) {
        bench.loop.step();
        worst = worseOf(worst, bench.loop.plant.velocity().norm() * kPerMillimetre);
    }
    return worst;
}

// The tools are changed to and fro. Returns the largest energy of hand and device in the last ten rounds over
// that in the first.
double growthOverRounds(const Variant& variant) {
    constexpr int kRounds = 20, kTicks = 60;
    Bench bench = onPlane(variant);
    double first = 0, last = 0;
    for (int round = 0; round < kRounds; ++round)
        for (const size_t tool : {kLargeTool, kSmallTool}) {
            bench.change(tool);
            for (int n = 0; n < kTicks; ++n) {
                bench.loop.step();
                if (!bench.loop.stepper.isFinite()) return kNan;
                double& largest = round < kRounds / 2 ? first : last;
                largest = std::max(largest, bench.loop.plant.energy());
            }
        }
    return last / first;
}

const std::vector<StabilityCase> kToolChangeCases{
    {"tool_change_jump_on_plane", "of_allowed", 1 + 1e-6, jumpOnPlane, {}, feltEffects()},
    {"tool_change_jump_in_hole", "of_allowed", 1 + 1e-6, jumpInHole, {}, feltEffects()},
    {"tool_change_jump_while_milling", "of_allowed", 1 + 1e-6, jumpWhileMilling, {}},
    {"tool_change_rest_on_plane",
     "N_rms",
     0.05,
     restOnPlane,
     {"thesis_2012"},
     feltEffectsBut({"cutting_force"})},
    {"tool_change_rest_in_hole", "N_rms", 0.05, restInHole, {"thesis_2012"}, feltEffects()},
    {"tool_change_left_in_plane", "voxels", 0.5, leftInPlane, {"thesis_2012"}},
    {"tool_change_drawn_out", "ms", 300, drawnOut, {}, feltEffectsBut({"cutting_force", "surface_friction"})},
    {"tool_change_lift", "mm/s", 100, liftSpeed, {}, feltEffects()},
    {"tool_change_growth", "ratio", 1.05, growthOverRounds, {}, feltEffects()},
};
BONEMILL_STABILITY_CASES(ToolChange, kToolChangeCases);

}  // namespace
}  // namespace bonemill::test
