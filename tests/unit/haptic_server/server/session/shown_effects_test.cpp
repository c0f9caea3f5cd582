#include "haptic_server/server/session/shown_effects.h"

#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "haptic_server/recording/statistics/state_hash.h"
#include "haptic_server/scene/setup/scene_materials.h"
#include "haptic_server/server/session/tick_recorder.h"

namespace bonemill {
namespace {

scene::Scene sceneOf(const std::string& text) {
    scene::Scene scene;
    EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &scene)) << text;
    return scene;
}
scene::Effects effectsOf(const std::string& text) {
    return sceneOf("effects { " + text + " }").effects();
}

EffectRecord busyRecord() {
    EffectRecord record{};
    record.events = kEventTooHot;
    record.protected_id = 1;
    record.spin_speed = 100;
    record.burr_force = 2;
    record.axis_torque = 0.5f;
    record.cutting_power = 8;
    record.temperature = 48;
    record.necrotic_volume = 1e-9f;
    record.protected_distance = 1e-3f;
    record.protected_force = 0.25f;
    record.damaged_volume = 2e-9f;
    return record;
}

TEST(ShownEffects, ViewersAreToldFromWhereOnTheBurrDistancesAreMeasured) {
    Burr burr;
    burr.radius = 1e-3;
    topics::SceneInfo info;
    describeBurr(sceneOf("material { name: 'enamel' }"), burr, info);
    EXPECT_EQ(info.burr_balls_m_size(), 0) << "nothing to protect";
    const scene::Scene scene = sceneOf("material { name: 'pulp' is_protected: true }");
    describeBurr(scene, burr, info);
    ASSERT_EQ(info.burr_balls_m_size(), 4);
    EXPECT_FLOAT_EQ(info.burr_balls_m(3), 1e-3f);
    burr.kind = BurrKind::kCylinder;
    burr.length = 4e-3;
    describeBurr(scene, burr, info);
    EXPECT_GT(info.burr_balls_m_size(), 4 * 16) << "balls and both rims";
    EXPECT_EQ(info.burr_balls_m_size() % 4, 0);
}

TEST(ShownEffects, TheWarningDistanceIsTheScenesOrTheFixtures) {
    EXPECT_DOUBLE_EQ(warningDistanceOf(effectsOf("protected_structures { warning_distance_mm: 4 }")), 4e-3);
    EXPECT_DOUBLE_EQ(warningDistanceOf(effectsOf("virtual_fixture { distance_mm: 0.5 }")), 0.5e-3);
    EXPECT_DOUBLE_EQ(
        warningDistanceOf(effectsOf("virtual_fixture {} protected_structures { warning_distance_mm: 3 }")),
        3e-3);
    EXPECT_DOUBLE_EQ(warningDistanceOf(effectsOf("")), 2e-3);
}

TEST(ShownEffects, ASceneWithoutThemShowsNothing) {
    for (const char* text : {"", "time_removal {}", "time_removal {} add_material {}",
                             "surface_friction {} virtual_fixture {}"}) {
        EXPECT_FALSE(ShownEffects(effectsOf(text)).areShown()) << text;
        EXPECT_FALSE(recordedEffectsOf(effectsOf(text)).any()) << text;
    }
    topics::SceneInfo info;
    describeToViewers(sceneOf("effects { time_removal {} spindle {} }"), info);
    EXPECT_EQ(info.ByteSizeLong(), 0u);
    topics::Status status;
    ShownEffects(effectsOf("energy_removal {} spindle {}")).describe(EffectStatistics(), {}, status);
    EXPECT_EQ(status.ByteSizeLong(), 0u);
}

TEST(ShownEffects, ViewersGetTheirEffectsAndNoOthers) {
    topics::SceneInfo info;
    describeToViewers(
        sceneOf("effects { time_removal {} energy_removal {} thermal {} bone_dust {} burr_spin {} }"), info);
    EXPECT_EQ(info.viewer_effects().SerializeAsString(),
              effectsOf("bone_dust {} burr_spin {}").SerializeAsString());
}

TEST(ShownEffects, OfMaterialsViewersGetNameColourAndCare) {
    const scene::Scene scene = sceneOf(R"(
        material { name: "enamel" from_value: 2000 stiffness_factor: 2 color { red: 0.5 } }
        material { name: "nerve" label: 3 is_protected: true })");
    topics::SceneInfo info;
    describeToViewers(scene, info);
    ASSERT_EQ(info.materials_size(), 2);
    EXPECT_EQ(info.materials(0).SerializeAsString(),
              sceneOf(R"(material { name: "enamel" color { red: 0.5 } })").material(0).SerializeAsString());
    EXPECT_EQ(info.materials(1).SerializeAsString(),
              sceneOf(R"(material { name: "nerve" is_protected: true })").material(0).SerializeAsString());
    EXPECT_TRUE(wantsVertexMaterials(scene));
    EXPECT_FALSE(wantsVertexMaterials(sceneOf(R"(material { name: "nerve" })")));
    EXPECT_FALSE(wantsVertexMaterials(sceneOf("material { name: 'core' } effects { bleeding {} }")));
    EXPECT_TRUE(
        wantsVertexMaterials(sceneOf("material { name: 'core' } effects { bleeding { material: 'core' } }")));
    EXPECT_EQ(materialNamesOf(scene), (std::vector<std::string>{"enamel", "nerve"}));
}

TEST(ShownEffects, EachEffectBringsItsOwnFigures) {
    const auto shown = [](const char* effects) {
        return ShownEffects(effectsOf(effects)).at(busyRecord(), {kEventNearProtected, 4}, 3e-9);
    };
    const topics::EffectState dust = shown("time_removal {} bone_dust {}");
    EXPECT_NEAR(dust.removed_mm3(), 3, 1e-12);
    EXPECT_EQ(dust.spin_speed(), 100);
    EXPECT_EQ(dust.events(), kEventNearProtected) << "of all ticks, not of the newest";
    EXPECT_FALSE(dust.has_cutting_power_w() || dust.has_temperature_c() || dust.has_damaged_mm3());
    const topics::EffectState spindle = shown("spindle {}");
    EXPECT_EQ(spindle.axis_torque_nm(), 0.5);
    EXPECT_EQ(spindle.cutting_power_w(), 8);
    EXPECT_FALSE(spindle.has_temperature_c() || spindle.has_damaged_mm3());
    const topics::EffectState heat = shown("thermal {}");
    EXPECT_EQ(heat.temperature_c(), 48);
    EXPECT_FLOAT_EQ(float(heat.necrotic_mm3()), 1);
    const topics::EffectState care = shown("protected_structures {}");
    EXPECT_EQ(care.protected_id(), 1u);
    EXPECT_EQ(care.event_id(), 4u) << "of the worst of all ticks' events, not of what is nearest now";
    EXPECT_FLOAT_EQ(float(care.protected_distance_m()), 1e-3f);
    EXPECT_FLOAT_EQ(float(care.damaged_mm3()), 2);
    EXPECT_FALSE(care.has_spin_speed() || care.has_temperature_c());
}

TEST(ShownEffects, NoNumberIsShownThatIsNone) {
    EffectRecord record = busyRecord();
    record.axis_torque = std::nanf("");
    record.protected_distance = std::numeric_limits<float>::infinity();
    const topics::EffectState state =
        ShownEffects(effectsOf("spindle {} protected_structures {}")).at(record, {}, 0);
    EXPECT_EQ(state.axis_torque_nm(), 0);
    EXPECT_FALSE(state.has_protected_distance_m());
    EXPECT_EQ(state.protected_id(), 0u);
}

TEST(ShownEffects, FiguresThatHaveALineAreShownInWords) {
    constexpr EffectFigure kFigures[] = {
        {.name = "waxed_mm2",
         .shown = {.unit = "mm\u00b2", .factor = 10, .line = "Waxed"},
         .told_with = {.own = 2},
         .slot = 1},
        {.name = "other", .shown = {.unit = "N", .line = "Other"}, .told_with = {.own = 1}, .slot = 0},
        {.name = "of_no_line", .told_with = {.own = 2}, .slot = 1}};
    EffectRecord record{};
    record.own[1] = 0.5f;
    topics::EffectState state;
    addLines(kFigures, record, {.own = 2}, state);
    ASSERT_EQ(state.figures_size(), 1);
    EXPECT_EQ(state.figures(0).words(), "Waxed");
    EXPECT_EQ(state.figures(0).value(), 5);
    EXPECT_EQ(state.figures(0).unit(), "mm\u00b2");
    record.own[1] = std::nanf("");
    addLines(kFigures, record, {.own = 2}, state);
    EXPECT_EQ(state.figures_size(), 1);
}

TEST(ShownEffects, TheStatusSaysHowCarefulTheSessionWas) {
    const scene::Effects effects = effectsOf("thermal {} protected_structures {}");
    EffectStatistics statistics(recordedEffectsOf(effects));
    EffectRecord record = busyRecord();
    record.events = kEventProtectedTouched;
    record.touched_id = 1;
    statistics.add(record);
    topics::Status status;
    ShownEffects(effects).describe(statistics, {"nerve"}, status);
    const topics::Training& training = status.training();
    EXPECT_FLOAT_EQ(float(training.damaged_mm3()), 2);
    EXPECT_FLOAT_EQ(float(training.least_distance_mm()), 1);
    EXPECT_EQ(training.nearest_structure(), "nerve");
    EXPECT_EQ(training.max_protected_force_n(), 0.25);
    EXPECT_FLOAT_EQ(float(training.necrotic_mm3()), 1);
    EXPECT_EQ(training.max_temperature_c(), 48);
    ASSERT_EQ(training.warnings_size(), 1);
    EXPECT_EQ(training.warnings(0), "touched nerve");
}

// Ticks come faster than tool states: none of their events may get lost, and no volume.
TEST(Recorder, EventsAndVolumeOfAllTicksReachTheNextToolState) {
    SpscRing<TickRecord> ring(64);
    Recorder recorder(ring, 1'000'000, {.burr = true, .protection = true});
    EXPECT_FALSE(recorder.takeSince());
    const auto tick = [&](uint64_t number, uint32_t events, double removed) {
        TickRecord record{};
        record.tick = number;
        record.start_ns = int64_t(number) * 1'000'000;
        record.effects.events = events;
        record.removed = removed;
        ring.tryPush(record);
    };
    tick(1, kEventSpindleStalled, 1e-9);
    tick(2, 0, 2e-9);
    recorder.drain();
    tick(3, kEventProtectedTouched, 0);
    tick(4, 0, 4e-9);
    recorder.drain();
    const auto since = recorder.takeSince();
    ASSERT_TRUE(since);
    EXPECT_EQ(since->latest.tick, 4u);
    EXPECT_EQ(since->events.events, kEventSpindleStalled | kEventProtectedTouched);
    EXPECT_DOUBLE_EQ(since->removed, 7e-9);
    const auto again = recorder.takeSince();
    ASSERT_TRUE(again);
    EXPECT_EQ(again->latest.tick, 4u);
    EXPECT_EQ(again->events.events, 0u);
    EXPECT_EQ(again->removed, 0);
    EXPECT_EQ(recorder.attempt().effects.warnings({}).size(), 2u);
}

TEST(EventSum, KnowsWhichStructureTheWorstWasAbout) {
    EffectRecord near{}, touched{}, damaged{};
    near.events = kEventNearProtected;
    near.protected_id = 1;
    touched.events = kEventNearProtected | kEventProtectedTouched;
    touched.protected_id = 1;
    touched.touched_id = 2;  // by the shaft
    damaged.events = kEventProtectedDamaged;
    damaged.protected_id = 1;
    damaged.damaged_id = 3;
    EventSum first, second;
    first.add(near);
    EXPECT_EQ(first.structure, 1u);
    first.add(touched);
    EXPECT_EQ(first.structure, 2u);
    first.add(near);
    EXPECT_EQ(first.structure, 2u);
    second.add(damaged);
    second.add(touched);
    EXPECT_EQ(second.structure, 3u);
    second.add(first);
    EXPECT_EQ(second.structure, 3u);
    first.add(second);
    EXPECT_EQ(first.structure, 3u);
    EXPECT_EQ(first.events, near.events | touched.events | damaged.events);
}

TEST(StateHash, EffectsCountOnlyWhereTheyAreRecorded) {
    const auto hashOf = [](float torque, const RecordedEffects& recorded) {
        TickRecord record{};
        record.effects.axis_torque = torque;
        StateHash hash;
        hash.addRecord(record, recorded);
        return hash.value();
    };
    EXPECT_EQ(hashOf(1, {}), hashOf(2, {}));
    EXPECT_NE(hashOf(1, {.burr = true}), hashOf(2, {.burr = true}));
    EXPECT_NE(hashOf(1, {.burr = true}), hashOf(1, {}));
    const auto hashOfOwn = [](float figure, const RecordedEffects& recorded) {
        TickRecord record{};
        record.effects.own[1] = figure;
        StateHash hash;
        hash.addRecord(record, recorded);
        return hash.value();
    };
    EXPECT_EQ(hashOfOwn(1, {.burr = true, .own = 1}), hashOfOwn(2, {.burr = true, .own = 1}));
    EXPECT_NE(hashOfOwn(1, {.own = 2}), hashOfOwn(2, {.own = 2}));
}

}  // namespace
}  // namespace bonemill
