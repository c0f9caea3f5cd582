#include <gtest/gtest.h>

#include "tests/unit/haptic_server/assessment/measures/hand_made_session.h"

namespace bonemill {
namespace {

using test::HandMadeSession;
using test::valueOf;

TechniqueScene sceneWithNerve() {
    TechniqueScene scene;
    scene.recorded.protection = true;
    scene.materials = {"bone", "nerve", "sinus"};
    return scene;
}

// The nerve is cut from 1 to 1.4 s, from 1.6 to 2 s (the same episode) and from 3 to 3.5 s, 1 mm³/s each.
HandMadeSession cutNerve() {
    HandMadeSession session;
    session.seconds = 5;
    session.contact = [](double) { return true; };
    session.force = [](double) { return 1.0; };
    double damaged = 0;
    session.more = [damaged](double t, TickRecord& record) mutable {
        const bool is_cut = (t > 1 && t <= 1.4) || (t > 1.6 && t <= 2) || (t > 3 && t <= 3.5);
        if (is_cut) {
            damaged += 1e-9 * 1e-3;
            record.effects.events = kEventProtectedDamaged | kEventProtectedTouched;
            record.effects.damaged_id = record.effects.touched_id = 2;
            record.effects.protected_force = 0.5;
        }
        record.effects.damaged_volume = float(damaged);
        record.effects.protected_id = t < 4 ? 2 : 3;
        record.effects.protected_distance = float(t < 4 ? 1e-3 * std::abs(t - 2.5) : 6e-3);
    };
    return session;
}

TEST(Structures, DamageComesInEpisodes) {
    const Figures figures = cutNerve().figures(sceneWithNerve());
    EXPECT_EQ(valueOf(figures, "damage.episodes:nerve"), 2);
    EXPECT_NEAR(valueOf(figures, "damage.volume:nerve"), 1.3, 0.005);
    EXPECT_NEAR(valueOf(figures, "damage.time:nerve"), 1.3, 0.005);
    EXPECT_NEAR(valueOf(figures, "structure.force:nerve"), 0.5, 1e-6);
    EXPECT_NEAR(valueOf(figures, "structure.distance:nerve"), 0, 1e-3);
    EXPECT_EQ(valueOf(figures, "damage.episodes:sinus"), 0);
    EXPECT_NEAR(valueOf(figures, "structure.distance:sinus"), 6, 1e-5);
    EXPECT_EQ(findFigure(figures, "damage.episodes:bone"), nullptr) << "never in reach";
}

// A gate may ask that it was not cut.
TEST(Structures, AProtectedOneThatWasNeverInReachWasNotCut) {
    TechniqueScene scene = sceneWithNerve();
    scene.materials.push_back("vessel");
    scene.are_protected = {false, true, true, true};
    const Figures figures = cutNerve().figures(scene);
    for (const char* figure : {"damage.episodes", "damage.volume", "damage.time", "structure.force"})
        EXPECT_EQ(valueOf(figures, std::string(figure) + ":vessel"), 0) << figure;
    EXPECT_EQ(findFigure(figures, "structure.distance:vessel"), nullptr) << "nobody knows";
    EXPECT_EQ(findFigure(figures, "damage.volume:bone"), nullptr) << "it may be cut";
}

TEST(Structures, EachEpisodeIsAMomentWithItsVolume) {
    Technique technique(sceneWithNerve());
    cutNerve().measure(technique);
    std::vector<Moment> damage;
    for (const Moment& moment : technique.moments())
        if (moment.kind == "damage") damage.push_back(moment);
    ASSERT_EQ(damage.size(), 2);
    EXPECT_NEAR(damage[0].t_s, 1, 2e-3);
    EXPECT_NEAR(damage[1].t_s, 3, 2e-3);
    EXPECT_EQ(damage[0].text, "nerve cut: 0.8 mm³");
    EXPECT_EQ(worstOf(technique.moments(), 3)[0].kind, "damage");
}

// 1 s in each range: 0.5 N and 10 mm/s near, 2 N and 40 mm/s far.
TEST(Structures, ForceAndSpeedGoByDistance) {
    HandMadeSession session;
    session.seconds = 4;
    session.contact = [](double) { return true; };
    session.force = [](double t) { return t < 2 ? 0.5 : 2.0; };
    session.place = [](double t) { return Eigen::Vector3d(t < 2 ? 0.01 * t : 0.02 + 0.04 * (t - 2), 0, 0); };
    session.more = [](double t, TickRecord& record) {
        record.effects.protected_id = t < 3 ? 2 : 0;
        record.effects.protected_distance = t < 1 ? 0.5e-3F : t < 2 ? 1.5e-3F : 3e-3F;
    };
    const Figures figures = session.figures(sceneWithNerve());
    EXPECT_NEAR(valueOf(figures, "near.force:below 1 mm"), 0.5, 0.005);
    EXPECT_NEAR(valueOf(figures, "near.force:1 to 2 mm"), 0.5, 0.005);
    EXPECT_NEAR(valueOf(figures, "near.force:2 to 4 mm"), 2, 0.02);
    EXPECT_NEAR(valueOf(figures, "near.force:beyond 4 mm"), 2, 0.02);  // none in reach
    EXPECT_NEAR(valueOf(figures, "near.speed:below 1 mm"), 10, 0.1);
    EXPECT_NEAR(valueOf(figures, "near.speed:2 to 4 mm"), 40, 0.4);
    EXPECT_NEAR(valueOf(figures, "near.time:1 to 2 mm"), 1, 0.01);
}

// 6 min at 43 °C, 1 min at 48 °C: 6 + 2^5 - and one degree less than 43 counts nothing.
TEST(Heat, TheDoseDoublesWithEachDegree) {
    TechniqueScene scene;
    scene.recorded.heat = true;
    HandMadeSession session;
    session.seconds = 180;
    session.rate = 50;
    session.more = [](double t, TickRecord& record) {
        record.effects.temperature = t <= 60 ? 44.F : t <= 120 ? 48.F : 42.F;
        record.effects.necrotic_volume = 3e-9F;
    };
    const Figures figures = session.figures(scene);
    EXPECT_NEAR(valueOf(figures, "heat.cem43"), 2 + 32, 0.05);
    EXPECT_NEAR(valueOf(figures, "heat.above_47"), 60, 0.05);
    EXPECT_EQ(valueOf(figures, "heat.peak"), 48);
    EXPECT_NEAR(valueOf(figures, "heat.necrotic"), 3, 1e-6);
}

TEST(Heat, ASceneWithoutHeatSaysNothingOfIt) {
    EXPECT_EQ(findFigure(HandMadeSession{}.figures(), "heat.peak"), nullptr);
}

}  // namespace
}  // namespace bonemill
