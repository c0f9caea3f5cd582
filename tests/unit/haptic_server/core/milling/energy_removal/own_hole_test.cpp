// A drill comes out of the hole that it made, however thick its shaft behind the burr.
#include <gtest/gtest.h>

#include <cmath>

#include "haptic_server/core/telemetry/fault_names.h"
#include "tests/support/milling_rig.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using test::MillingRig;
using test::RigConfig;

constexpr double kDepth = 6e-3;  // m
const Eigen::Quaterniond kBoringDown(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitX()));
constexpr double kForces[] = {3, 0.5, 1, 1.5, 4, 9};  // N, of a pull

struct Drill {
    BurrKind kind;
    double radius, voxel, shaft;  // m
    Preset preset;
    double friction;  // of the shaft; 0: none
};

RigConfig rigOf(const Drill& drill) {
    RigConfig config;
    const double side = 2 * drill.radius + 3e-3;
    config.size = {side, side, kDepth + 2e-3 + 6 * drill.voxel};
    config.surface = kDepth + 2e-3;
    config.spacing.setConstant(drill.voxel);
    config.burr = {.kind = drill.kind, .radius = drill.radius, .length = 2.5e-3, .speed = 2 * test::kKrpm};
    config.edge_radius = kEdgeRadius;
    config.shaft_radius = drill.shaft;
    config.shaft_end = 14e-3;
    config.rotation = kBoringDown;
    config.preset = drill.preset;
    config.hand_stiffness = 1000;
    config.has_budget = true;
    config.removal.specific_energy = 0.1e9;
    if (drill.friction > 0) {
        config.friction = test::kSurfaceFriction;
        config.friction->coefficient = drill.friction;
    }
    return config;
}

// It bores, pulls the drill out with each force in turn, and in between puts it back.
class BoringHand {
  public:
    // `above` is where the drill stands over the hole to be; `stiffness` is the coupling's.
    BoringHand(const Vector3d& above, double stiffness) : above_(above), stiffness_(stiffness) {}

    Vector3d operator()(const Vector3d& p_spo) {
        const double height = p_spo.z() - above_.z(), moved = height - std::exchange(last_, height);
        if (isInPlace(height) || ++ticks_ > kLongest) goOn();
        const double ramp = std::min(1.0, ticks_ / 20.0);
        const double to = isPutBack() ? std::max(-kDepth + 0.1e-3, -20e-6 * ticks_)
                                      : height + moved + ramp * force() / stiffness_;
        return above_ + Vector3d(0, 0, to);
    }
    bool isDone() const { return step_ >= 2 * std::ssize(kForces); }
    bool hasBored() const { return step_ > 0; }
    const std::vector<double>& jammedAt() const { return jammed_at_; }  // N

  private:
    static constexpr double kThrust = 20;                      // N
    static constexpr int kLongest = 6000, kLongestPull = 300;  // ticks

    // Boring, pulling, putting back, pulling, ...
    bool isPutBack() const { return step_ > 0 && step_ % 2 == 0; }
    double force() const { return step_ == 0 ? -kThrust : kForces[step_ / 2]; }
    bool isInPlace(double height) {
        if (step_ == 0) return height < -kDepth;
        if (isPutBack()) return height < -kDepth + 0.2e-3;
        if (height > 0) return true;
        if (ticks_ < kLongestPull) return false;
        jammed_at_.push_back(force());
        return true;
    }
    void goOn() { ++step_, ticks_ = 0; }

    Vector3d above_;
    double stiffness_, last_ = 0;
    int step_ = 0, ticks_ = 0;
    std::vector<double> jammed_at_;
};

// How deep inside the burr, somewhere on its way, there still is bone, m.
double deepestLeft(const MillingRig& rig) {
    constexpr size_t kEvery = 32;  // ticks
    double deepest = 0;
    const BoneModel& bone = rig.bone;
    for (LeafId leaf = 0; leaf < bone.lattice.leafCount(); ++leaf)
        bone.shell.forEachBlock(0, leaf, [&](const ShellBlock& b, uint32_t count) {
            for (uint32_t n = 0; n < count; ++n)
                for (size_t tick = 0; tick < rig.records.size(); tick += kEvery) {
                    const Vector3d r =
                        Vector3d(b.x[n], b.y[n], b.z[n]) - Eigen::Map<const Vector3d>(rig.records[tick].p_WT);
                    deepest = std::max(deepest, -rig.config.burr.signedDistance(kBoringDown.conjugate() * r));
                }
        });
    return deepest;
}

class OwnHoleOf : public testing::TestWithParam<Drill> {};

TEST_P(OwnHoleOf, LetsTheDrillOutAtAnyForce) {
    const Drill& drill = GetParam();
    MillingRig rig(rigOf(drill));
    const double tip = drill.kind == BurrKind::kBall ? drill.radius : rig.config.burr.length / 2;
    const Vector3d above = rig.center() + Vector3d(20e-6, -17e-6, tip + 0.05e-3);
    BoringHand hand(above, rig.config.hand_stiffness);
    while (!hand.isDone()) rig.run(0.1, above, [&](double, const Vector3d& p) { return hand(p); });
    ASSERT_TRUE(hand.hasBored());
    EXPECT_TRUE(hand.jammedAt().empty()) << testing::PrintToString(hand.jammedAt());
    uint32_t faults = 0;
    for (const TickRecord& record : rig.records) faults |= record.faults;
    EXPECT_FALSE(faults & (kFaultContactOverflow | kFaultCoarserShell)) << faultNames(faults);
    if (drill.kind == BurrKind::kBall) EXPECT_LT(deepestLeft(rig), 0.2 * drill.voxel);
}

const Drill kDrills[] = {
    {BurrKind::kCylinder, 1.25e-3, 1.25e-3 / 6, 1.25e-3, Preset::kFast, 0},
    {BurrKind::kCylinder, 1.25e-3, 1.25e-3 / 6, 1.25e-3, Preset::kBalanced, 0.2},
    {BurrKind::kCylinder, 1.25e-3, 1.25e-3 / 6, 1.25e-3, Preset::kExact, 0},
    {BurrKind::kCylinder, 1.25e-3, 1.25e-3 / 6, 1e-3, Preset::kBalanced, 0},
    {BurrKind::kBall, 1.25e-3, 1.25e-3 / 6, 1.25e-3, Preset::kBalanced, 0.2},
};
INSTANTIATE_TEST_SUITE_P(Drills, OwnHoleOf, testing::ValuesIn(kDrills));

}  // namespace
}  // namespace bonemill
