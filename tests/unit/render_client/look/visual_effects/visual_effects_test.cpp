#include "render_client/look/visual_effects/visual_effects.h"

#include <gtest/gtest.h>

#include <limits>

namespace bonemill {
namespace {

constexpr double kRadius = 1e-3;

// Makes a level floor of bone at z = 0, 8 mm × 8 mm; `dent` lowers the vertices within 1 mm of the middle.
NodeMesh floorMesh(uint16_t dent = 0) {
    NodeMesh mesh;
    mesh.leaf = 3;
    mesh.origin = Eigen::Vector3f(-4e-3f, -4e-3f, -1e-3f);
    mesh.step.setConstant(1e-6f);
    constexpr int kSide = 41;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const bool is_dented = (x - 20) * (x - 20) + (y - 20) * (y - 20) < 25;
            mesh.vertices.push_back(
                {uint16_t(200 * x), uint16_t(200 * y), uint16_t(1000 - (is_dented ? dent : 0)), 0, 0});
        }
    for (uint32_t y = 0; y + 1 < kSide; ++y)
        for (uint32_t x = 0; x + 1 < kSide; ++x) {
            const uint32_t a = y * kSide + x, b = a + kSide;
            mesh.indices.insert(mesh.indices.end(), {a, a + 1, b, b, a + 1, b + 1});
        }
    return mesh;
}

EffectInput burrAt(const Eigen::Vector3d& p_V, bool is_pedal_down, double removed = 0) {
    EffectInput input;
    input.X_VT = Pose{p_V, rotationBetween(Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ())};
    input.burr_radius = kRadius;
    input.is_pedal_down = is_pedal_down;
    input.spin_speed = 3000;
    input.removed = removed;
    return input;
}

scene::Effects everything() {
    scene::Effects wish;
    wish.mutable_bone_dust();
    wish.mutable_bleeding();
    wish.mutable_irrigation();
    wish.mutable_burr_spin();
    return wish;
}

TEST(VisualEffects, whatIsNotListedDoesNotExist) {
    scene::Effects wish;
    wish.mutable_spindle();
    wish.mutable_milling_sound();
    EXPECT_FALSE(VisualEffects::anyIn(wish));
    wish.mutable_bone_dust();
    EXPECT_TRUE(VisualEffects::anyIn(wish));
    VisualEffects effects(wish, kRadius);
    EXPECT_TRUE(effects.dust());
    EXPECT_FALSE(effects.film() || effects.bleeding() || effects.irrigation() || effects.spin());
}

// Quick pictures with a new film are slow: the more so, the more others come between.
TEST(VisualEffects, slowPicturesOfTheFilmLeaveTimeToOthers) {
    const auto shownIn = [](double quick, double slow) {
        VisualEffects effects(everything(), kRadius);
        effects.film()->takeDue();
        int shown = 0;
        bool was_slow = false;
        for (double time = 0; time < 6;) {
            const double took = was_slow ? slow : quick;
            effects.advance(took);
            time += took;
            was_slow = effects.film()->takeDue();
            shown += was_slow;
        }
        return shown;
    };
    EXPECT_NEAR(shownIn(0.02, 0.02), 40, 2);
    EXPECT_NEAR(shownIn(0.02, 0.2), 10, 1);
    EXPECT_NEAR(shownIn(0.02, 0.25), 8, 1);
}

TEST(BoneDust, leavesInProportionFliesAndSettlesOnTheBone) {
    scene::Effects wish;
    wish.mutable_bone_dust()->set_grains_per_mm3(100);
    VisualEffects effects(wish, kRadius);
    effects.setNode(floorMesh());
    effects.take(burrAt({0, 0, 1.5e-3}, true, 2e-9));
    effects.advance(VisualEffects::kStep * 1.5);
    EXPECT_EQ(effects.dust()->count(), 200u);
    Particles particles;
    effects.dust()->appendTo(particles);
    for (const Particle& p : particles)
        EXPECT_NEAR((p.p_V - Eigen::Vector3f(0, 0, 1.5e-3f)).norm(), kRadius, 4e-3);
    for (int n = 0; n < 30; ++n) effects.advance(0.1);
    EXPECT_GT(effects.dust()->restingCount(), 20u);
    particles.clear();
    effects.dust()->appendTo(particles);
    for (const Particle& p : particles)
        if (p.streak_V.norm() == 0) {
            EXPECT_NEAR(p.p_V.z(), p.radius, 2e-5) << "lies on the floor";
        }
    for (int n = 0; n < 300; ++n) effects.advance(0.1);
    particles.clear();
    effects.dust()->appendTo(particles);
    EXPECT_TRUE(particles.empty()) << "has faded";
}

TEST(BoneDust, neverKeepsMoreThanItMay) {
    scene::Effects wish;
    wish.mutable_bone_dust()->set_most_grains(50);
    VisualEffects effects(wish, kRadius);
    for (int n = 0; n < 20; ++n) {
        effects.take(burrAt({0, 0, 0}, true, 1e-7));
        effects.advance(0.05);
    }
    EXPECT_EQ(effects.dust()->count(), 50u);
}

TEST(Bleeding, onlyWhereTheBurrHasCutAndAfterItsDelay) {
    scene::Effects wish;
    wish.mutable_bleeding()->set_delay_s(0.5);
    wish.mutable_bleeding()->set_runs_per_s(0);
    VisualEffects effects(wish, kRadius);
    effects.setNode(floorMesh());
    effects.take(burrAt({0, 0, 0.7e-3}, true));
    effects.setNode(floorMesh(300));
    effects.advance(0.2);
    const Eigen::Vector3f cut(0, 0, -3e-4f), beside(2.6e-3f, 0, 0);
    EXPECT_GT(effects.bleeding()->woundCount(), 5u);
    EXPECT_EQ(effects.film()->at(SurfaceFilm::kBlood, cut), 0);
    effects.take(burrAt({0, 0, 4e-3}, false));
    for (int n = 0; n < 40; ++n) effects.advance(0.1);
    EXPECT_GT(effects.film()->at(SurfaceFilm::kBlood, cut), 0.4f);
    EXPECT_EQ(effects.film()->at(SurfaceFilm::kBlood, beside), 0);
}

// One half of the floor is of the material that bleeds, the other of one that does not.
TEST(Bleeding, onlyOfTheMaterialsNamed) {
    const auto wounds = [](const std::string& named) {
        scene::Effects wish;
        if (!named.empty()) wish.mutable_bleeding()->add_material(named);
        wish.mutable_bleeding();
        VisualEffects::Materials materials;
        materials.Add()->set_name("cortex");
        materials.Add()->set_name("core");
        VisualEffects effects(wish, kRadius, materials);
        NodeMesh before = floorMesh(), after = floorMesh(300);
        for (const PackedVertex& v : after.vertices) after.materials.push_back(v.x < 4000 ? 1 : 2);
        before.materials = after.materials;
        effects.setNode(before);
        effects.take(burrAt({0, 0, 0.7e-3}, true));
        effects.setNode(after);
        effects.advance(0.2);
        return effects.bleeding()->woundCount();
    };
    const size_t of_all = wounds(""), of_core = wounds("core"), of_cortex = wounds("cortex");
    EXPECT_GT(of_core, 2u);
    EXPECT_GT(of_cortex, 2u);
    EXPECT_GT(of_all, std::max(of_core, of_cortex));
    EXPECT_EQ(wounds("marrow"), 0u);
}

// The mesh changes where no burr cuts: the bone was put back, or another tool works there.
TEST(Bleeding, notWhereNothingWasCut) {
    VisualEffects effects(everything(), kRadius);
    effects.setNode(floorMesh());
    effects.take(burrAt({0, 0, 0.7e-3}, false));
    effects.setNode(floorMesh(300));
    for (int n = 0; n < 10; ++n) effects.advance(0.1);
    EXPECT_EQ(effects.bleeding()->woundCount(), 0u);
}

TEST(Irrigation, wetsWhileThePedalIsDownAndDriesAfterwards) {
    scene::Effects wish;
    wish.mutable_irrigation()->set_drying_time_s(0.5);
    VisualEffects effects(wish, kRadius);
    effects.setNode(floorMesh());
    effects.take(burrAt({0, 0, 1e-3}, false));
    for (int n = 0; n < 5; ++n) effects.advance(0.1);
    EXPECT_EQ(effects.irrigation()->count(), 0u);
    effects.take(burrAt({0, 0, 1e-3}, true));
    for (int n = 0; n < 10; ++n) effects.advance(0.1);
    EXPECT_GT(effects.irrigation()->count(), 0u);
    const Eigen::Vector3f near_burr(3e-4f, 0, 1e-5f);
    EXPECT_GT(effects.film()->at(SurfaceFilm::kWater, near_burr), 0.3f);
    effects.take(burrAt({0, 0, 1e-3}, false));
    for (int n = 0; n < 100; ++n) effects.advance(0.1);
    EXPECT_EQ(effects.irrigation()->count(), 0u);
    EXPECT_EQ(effects.film()->at(SurfaceFilm::kWater, near_burr), 0);
}

// What comes afterwards leaves its traces on the same bone.
TEST(VisualEffects, ofBoneThatWasPutBackNothingIsRemembered) {
    scene::Effects wish = everything();
    wish.mutable_bleeding()->set_delay_s(0.1);
    VisualEffects effects(wish, kRadius);
    const Eigen::Vector3f cut(0, 0, -3e-4f);
    const auto mill = [&] {
        effects.setNode(floorMesh());
        effects.take(burrAt({0, 0, 0.7e-3}, true, 2e-9));
        effects.setNode(floorMesh(300));
        effects.advance(0.2);
        effects.take(burrAt({0, 0, 4e-3}, false));
        for (int n = 0; n < 10; ++n) effects.advance(0.1);
    };
    mill();
    EXPECT_GT(effects.film()->at(SurfaceFilm::kBlood, cut), 0);
    effects.forget();
    EXPECT_EQ(effects.film()->at(SurfaceFilm::kBlood, cut), 0);
    EXPECT_EQ(effects.dust()->count(), 0u);
    EXPECT_EQ(effects.irrigation()->count(), 0u);
    effects.setNode(floorMesh());
    for (int n = 0; n < 20; ++n) effects.advance(0.1);
    EXPECT_EQ(effects.bleeding()->woundCount(), 0u) << "the bone that comes back was not cut";
    EXPECT_EQ(effects.film()->at(SurfaceFilm::kBlood, cut), 0);
    mill();
    EXPECT_GT(effects.film()->at(SurfaceFilm::kBlood, cut), 0);
}

TEST(BurrSpin, turnsWithTheSpeedAndSaysHowFarWithinAPicture) {
    BurrSpin spin{scene::BurrSpin()};
    EXPECT_EQ(spin.takeTurn().sweep, 0);
    spin.advance(0.01, 100);
    spin.advance(0.01, 100);
    const BurrTurn turn = spin.takeTurn();
    EXPECT_NEAR(turn.angle, 2.0, 1e-6);
    EXPECT_NEAR(turn.sweep, 2.0, 1e-6);
    EXPECT_NEAR(spin.takeTurn().sweep, 2.0, 1e-6) << "the same picture again";
    spin.advance(1, -100);
    EXPECT_NEAR(spin.takeTurn().sweep, -100.0 / 24, 1e-4) << "slow pictures are stills";
}

TEST(VisualEffects, areTheSameForTheSameStates) {
    const auto run = [] {
        VisualEffects effects(everything(), kRadius);
        effects.setNode(floorMesh());
        for (int n = 0; n < 30; ++n) {
            effects.take(burrAt({1e-4 * n, 0, 7e-4}, true, 1e-10));
            effects.setNode(floorMesh(uint16_t(10 * n)));
            effects.advance(1.0 / 60);
        }
        Particles particles;
        effects.dust()->appendTo(particles);
        effects.irrigation()->appendTo(particles);
        float sum = 0;
        for (const Particle& p : particles) sum += p.p_V.sum();
        return std::pair(particles.size(), sum);
    };
    EXPECT_GT(run().first, 20u);
    EXPECT_EQ(run(), run());
}

TEST(EffectInput, isBoundedWhateverCame) {
    topics::SceneInfo info;
    topics::ToolState tool;
    info.set_burr_radius_m(1e300);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    tool.mutable_effects()->set_spin_speed(nan);
    tool.mutable_effects()->set_removed_mm3(1e300);
    tool.mutable_effects()->set_burr_force_n(-5);
    const EffectInput input = effectInputOf(tool, info);
    EXPECT_FALSE(input.X_VT);
    EXPECT_EQ(input.spin_speed, 0);
    EXPECT_EQ(input.burr_force, 0);
    EXPECT_LE(input.removed, 1e-7);
    EXPECT_LE(input.burr_radius, 0.05);
    VisualEffects effects(everything(), input.burr_radius);
    effects.take(input);
    effects.advance(1e300);
    effects.advance(nan);
}

}  // namespace
}  // namespace bonemill
