#include <gtest/gtest.h>

#include "haptic_server/core/effects/burr_probes.h"
#include "tests/support/typical_effects.h"
#include "tests/unit/haptic_server/core/effects/tissue_bench.h"

namespace bonemill {
namespace {

using namespace test;
using Eigen::Vector3d;

constexpr double kMiddle = 4e-3;

// Makes a layer of nerve across the whole block, from z = low to high.
DistanceFunction layer(double low, double high) {
    return [=](const Vector3d& p) { return std::max(low - p.z(), p.z() - high); };
}

struct ProtectedBench : TissueBench {
    explicit ProtectedBench(const DistanceFunction& nerve) : TissueBench(nerve) {
        config.effects.time_removal = test::kTimeRemoval;
        config.effects.protected_structures = {.warning_distance = 1e-3};
    }
};

TEST(ProtectedStructures, DistanceIsThatOfTheBurrsSurface) {
    ProtectedBench bench(layer(0, 3e-3 + kVoxel / 2));  // its last voxels' faces lie at 3.0625 mm
    FixedTick tick = bench.makeTick();
    bool was_far = false, was_near = false;
    for (const TickRecord& record : bench.run(tick, straightPath(TissueBench::at({kMiddle, kMiddle, 9e-3}),
                                                                 {kMiddle, kMiddle, 6e-3}, 500, 0))) {
        const double expected = record.p_WT[2] - kBurr - 3.0625e-3;
        const EffectRecord& effects = record.effects;
        if (expected > 3e-3) {
            EXPECT_EQ(effects.protected_id, 0u);
            was_far = true;
        } else if (expected < 2.9e-3) {
            EXPECT_NEAR(effects.protected_distance, expected, 1e-6);
            EXPECT_EQ(effects.protected_id, kNerve);
            was_near = true;
        }
        EXPECT_EQ(effects.events, 0u);
        EXPECT_EQ(effects.damaged_volume, 0);
    }
    EXPECT_TRUE(was_far && was_near);
}

// The burr goes straight down through the layer and leaves a hole of its own section.
TEST(ProtectedStructures, DamageIsTheVolumeThatTheBurrSwept) {
    ProtectedBench bench(layer(2.5e-3 - kVoxel / 2, 3.5e-3 - kVoxel / 2));
    FixedTick tick = bench.makeTick();
    const Vector3d end(kMiddle, kMiddle, 1.2e-3);
    auto inputs = straightPath(TissueBench::at({kMiddle, kMiddle, 6.2e-3}), end, 4000, kButtonRemove);
    inputs.insert(inputs.end(), 500, inputs.back());
    uint32_t events = 0;
    double last_damage = 0;
    for (const TickRecord& record : bench.run(tick, inputs)) {
        const EffectRecord& effects = record.effects;
        EXPECT_GE(effects.damaged_volume, last_damage);
        EXPECT_EQ(bool(effects.events & kEventProtectedDamaged), effects.damaged_volume > last_damage);
        EXPECT_EQ(bool(effects.events & kEventNearProtected), effects.protected_distance < 1e-3);
        last_damage = effects.damaged_volume;
        events |= effects.events;
    }
    EXPECT_TRUE(events & kEventProtectedTouched);
    const double swept = M_PI * kBurr * kBurr * 1e-3;
    EXPECT_NEAR(last_damage / swept, 1, 0.05);
    // It stays, though nobody cuts any more.
    EXPECT_EQ(bench.run(tick, straightPath(TissueBench::at(end), end, 10, 0)).back().effects.damaged_volume,
              float(last_damage));
}

// The burr stays where it has done its damage, so that lost bone would count again while it is on its way
// back.
TEST(ProtectedStructures, DamageIsForgottenWithTheScannedBoneAndNotWithACheckpoint) {
    ProtectedBench bench(layer(2.5e-3, 7e-3));
    BoneHistory history(bench.bone);
    FixedTick tick = bench.makeTick(&history);
    const Vector3d end(kMiddle, kMiddle, kTop + kBurr - 0.8e-3);
    const auto milling = straightPath(TissueBench::at({kMiddle, kMiddle, 6.2e-3}), end, 400, kButtonRemove);
    const auto standing = straightPath(TissueBench::at(end), end, 100, 0);
    const auto damaged = [&](const std::vector<DeviceInput>& inputs) {
        return bench.run(tick, inputs).back().effects.damaged_volume;
    };
    const auto whole = history.snapshot(bench.bone);
    const float first = damaged(milling);
    EXPECT_GT(first, 0);
    const uint64_t to_checkpoint = history.restore(whole);
    EXPECT_EQ(damaged(standing), first);
    EXPECT_EQ(history.finishedOrder(), to_checkpoint);
    damaged(milling);
    const uint64_t to_scan = history.restore();
    EXPECT_GT(to_scan, to_checkpoint);
    for (const TickRecord& record : bench.run(tick, standing)) {
        EXPECT_EQ(record.effects.damaged_volume, 0);
        EXPECT_FALSE(record.effects.events & kEventProtectedDamaged);
    }
    EXPECT_EQ(history.missingVoxels(), 0);
    EXPECT_EQ(bench.run(tick, standing).back().bone_order, to_scan);
    EXPECT_NEAR(damaged(milling) / first, 1, 0.1) << "it counts anew";
}

TEST(ProtectedStructures, ABurrThatStandsStillHarmsNothing) {
    ProtectedBench bench(layer(3.5e-3, 7e-3));  // up into the air above the bone
    FixedTick tick = bench.makeTick();
    const Vector3d place(kMiddle, kMiddle, kTop + kBurr + 0.2e-3);
    EXPECT_EQ(
        bench.run(tick, straightPath(TissueBench::at(place), place, 50, 0)).back().effects.damaged_volume, 0);
    const auto records = bench.run(tick, straightPath(TissueBench::at(place), place, 50, kButtonRemove));
    // Soft tissue that is no bone is lost inside the burr as well: all but the burr's upper 0.2 mm is in it.
    const double cap = 0.2e-3;
    const double expected = 4.0 / 3 * M_PI * std::pow(kBurr, 3) - M_PI * cap * cap * (kBurr - cap / 3);
    EXPECT_NEAR(records.back().effects.damaged_volume / expected, 1, 0.05);
}

TEST(ProtectedStructures, ForceIsThatOfTheContactsOnThem) {
    for (const bool is_nerve_on_top : {true, false}) {
        ProtectedBench bench(is_nerve_on_top ? layer(3e-3, 7e-3) : layer(0, 3e-3));
        FixedTick tick = bench.makeTick();
        const Vector3d end(kMiddle, kMiddle, kTop + kBurr - 0.5e-3);
        auto inputs = straightPath(TissueBench::at({kMiddle, kMiddle, 6.2e-3}), end, 200, 0);
        inputs.insert(inputs.end(), 200, inputs.back());
        const TickRecord last = bench.run(tick, inputs).back();
        EXPECT_GT(last.f_hand_W[2], 0.5);
        if (is_nerve_on_top)
            EXPECT_NEAR(last.effects.protected_force / last.f_hand_W[2], 1, 0.03);
        else
            EXPECT_EQ(last.effects.protected_force, 0);
        EXPECT_EQ(bool(last.effects.events & kEventProtectedTouched), is_nerve_on_top);
    }
}

// The spindle's burr that stands removes nothing, and covers nothing.
TEST(ProtectedStructures, AStalledBurrHarmsNothing) {
    ProtectedBench bench(layer(2.5e-3, 7e-3));
    bench.config.tool.burr.speed = 4000;
    bench.config.effects.spindle = test::kSpindle;
    bench.config.effects.spindle->max_torque = 0.2e-3;
    FixedTick tick = bench.makeTick();
    const Vector3d end(kMiddle, kMiddle, kTop + kBurr - 0.8e-3);
    auto inputs = straightPath(TissueBench::at({kMiddle, kMiddle, 6.2e-3}), end, 200, 0);
    DeviceInput pressed = inputs.back();
    pressed.buttons = kButtonRemove;  // only now that it stands in bone
    inputs.insert(inputs.end(), 1500, pressed);
    const auto records = bench.run(tick, inputs);
    EXPECT_TRUE(records.back().effects.events & kEventSpindleStalled);
    EXPECT_TRUE(records.back().effects.events & kEventProtectedTouched);
    double removed = 0;
    for (const TickRecord& record : records) removed += record.removed;
    EXPECT_EQ(removed, 0);
    EXPECT_EQ(records.back().effects.damaged_volume, 0);
}

// The burr is so large that a tick does not see all of it on its way past a thin structure.
TEST(ProtectedStructures, ALargeBurrMissesNothingOnItsWay) {
    constexpr double kLarge = 2.5e-3, kSpeed = 50e-3;       // m, m/s
    const DistanceFunction nerve = [](const Vector3d& p) {  // in the air
        return std::hypot(p.y() - kMiddle, p.z() - 7.5e-3) - 0.3e-3;
    };
    ProtectedBench bench(nerve);
    bench.config.tool.burr.radius = kLarge;
    const ToolModel large = sphereToolModel(kLarge, 2 * kVoxel);
    bench.config.tool.model = &large;
    FixedTick tick(bench.config, bench.bone);
    const Vector3d start(kMiddle, kMiddle - 8e-3, 7.6e-3), end(kMiddle, kMiddle + 8e-3, 7.6e-3);
    const auto records =
        bench.run(tick, straightPath(TissueBench::at(start), end, int(16e-3 / kSpeed * 1e3), kButtonRemove));
    const double covered = M_PI * 0.3e-3 * 0.3e-3 * 2 * kLarge;
    EXPECT_NEAR(records.back().effects.damaged_volume / covered, 1, 0.15);
}

// A long thin burr beside a ball as thin is never told to be farther than it is by more than a tenth of
// the radius.
TEST(BurrProbes, SeeAThinStructureBesideALongBurr) {
    const Vector3d nerve(kMiddle, kMiddle, 4e-3);
    const TissueBench bench(sphereAt(nerve, 0.3e-3), 4e-3);
    const Burr burr{.kind = BurrKind::kCylinder, .radius = 0.5e-3, .length = 7e-3};
    for (int n = 0; n <= 20; ++n) {
        const double along = (n / 20.0 - 0.5) * 5e-3;
        const Pose pose{nerve + Vector3d(1.5e-3, along, 0), Eigen::Quaterniond::Identity()};
        const NearestStructure nearest =
            nearestStructure(*bench.config.effects.protected_field, BurrProbes(burr), pose);
        EXPECT_NEAR(nearest.distance, 1.5e-3 - 0.3e-3 - burr.radius, 0.12 * burr.radius + kVoxel / 2)
            << along;
    }
}

// Over a flat structure the lowest point of a burr with edges counts, however the burr leans.
TEST(BurrProbes, ReachAsFarAsTheBurr) {
    const TissueBench bench(layer(0, 3e-3 + kVoxel / 2), 6e-3);
    for (const BurrKind kind : {BurrKind::kBall, BurrKind::kCylinder, BurrKind::kCone}) {
        Burr burr{.kind = kind, .radius = 1e-3, .length = 3e-3, .tip_radius = 0.4e-3};
        const double tip = kind == BurrKind::kCone ? burr.tip_radius : burr.radius;
        for (const double lean : {0.0, 0.3, 1.0, M_PI / 2}) {
            const Pose pose{{kMiddle, kMiddle, 7e-3}, expRotation({M_PI / 2 - lean, 0, 0})};
            // The lowest point is on one of the two rims of a body of revolution, its axis at this angle from
            // the vertical.
            const double up = std::cos(lean), across = std::sin(lean);
            const double lowest =
                std::max(burr.length / 2 * up + tip * across, -burr.length / 2 * up + burr.radius * across);
            const double below = kind == BurrKind::kBall ? burr.radius : lowest;
            const NearestStructure nearest =
                nearestStructure(*bench.config.effects.protected_field, BurrProbes(burr), pose);
            EXPECT_NEAR(nearest.distance, 7e-3 - 3.0625e-3 - below, 0.08e-3) << int(kind) << " " << lean;
            EXPECT_EQ(nearest.material, kNerve);
        }
    }
}

}  // namespace
}  // namespace bonemill
