#include "render_client/look/hud/effect_lines.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/hud_rows.h"

namespace bonemill {
namespace {

using topics::EffectState;
using namespace std::chrono_literals;

topics::SceneInfo infoWithNerve() {
    topics::SceneInfo info;
    info.add_materials()->set_name("cortical bone");
    info.add_materials()->set_name("facial nerve");
    info.add_materials();
    return info;
}

TEST(EffectText, OnlyWhatTheSceneListsIsShown) {
    EXPECT_TRUE(effectTaskRows({}, nullptr, 0).empty());
    EXPECT_TRUE(effectDetailRows({}).empty());
    EffectState state;
    state.set_spin_speed(0);
    EXPECT_TRUE(effectTaskRows(state, nullptr, 0).empty()) << "what the motor does is no figure of the task";
    const std::vector<HudRow> rows = effectDetailRows(state);
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].label, "Spindle");
    EXPECT_EQ(rows[0].value, "0 rpm");
}

TEST(EffectText, FiguresHaveUnits) {
    EffectState state;
    state.set_spin_speed(-4000 * 2 * M_PI / 60);
    state.set_axis_torque_nm(2.9e-3);
    state.set_cutting_power_w(18.04);
    state.set_temperature_c(38.26);
    state.set_necrotic_mm3(0);
    state.set_damaged_mm3(0.4);
    const std::vector<HudRow> details = effectDetailRows(state);
    EXPECT_EQ(test::findRow(details, "Spindle")->value, "-4000 rpm");
    EXPECT_EQ(test::findRow(details, "Load")->value, "2.90 N\u00b7mm");
    EXPECT_EQ(test::findRow(details, "Cutting")->value, "18.0 W");
    const std::vector<HudRow> rows = effectTaskRows(state, nullptr, 0);
    EXPECT_EQ(test::findRow(rows, "Hottest bone")->value, "38.3 \u00b0C");
    EXPECT_EQ(test::findRow(rows, "Necrosis")->value, "none");
    EXPECT_EQ(test::findRow(rows, "Necrosis")->tone, HudTone::kGood);
    EXPECT_EQ(test::findRow(rows, "Damaged")->value, "0.40 mm\u00b3");
    EXPECT_EQ(test::findRow(rows, "Damaged")->tone, HudTone::kAlarm);
}

TEST(EffectText, AFigureOfAnyEffectIsALine) {
    EffectState state;
    topics::ShownFigure& figure = *state.add_figures();
    figure.set_words("Waxed");
    figure.set_value(12.34);
    figure.set_unit("mm\u00b2");
    const std::vector<HudRow> rows = effectTaskRows(state, nullptr, 0);
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].label, "Waxed");
    EXPECT_EQ(rows[0].value, "12.3 mm\u00b2");
}

TEST(EffectText, NothingHasNoSign) {
    EffectState state;
    state.set_axis_torque_nm(-4e-6);
    EXPECT_EQ(test::findRow(effectDetailRows(state), "Load")->value, "0.00 N\u00b7mm");
    state.set_axis_torque_nm(-6e-6);
    EXPECT_EQ(test::findRow(effectDetailRows(state), "Load")->value, "-0.01 N\u00b7mm");
}

TEST(EffectText, WhatIsFarFromEveryStructureKeepsItsLine) {
    EffectState state;
    state.set_damaged_mm3(0);
    const size_t far = effectTaskRows(state, nullptr, 0).size();
    EXPECT_EQ(test::findRow(effectTaskRows(state, nullptr, 0), "Protected")->value, "far");
    state.set_protected_distance_m(1e-3);
    EXPECT_EQ(effectTaskRows(state, nullptr, 0).size(), far)
        << "the list does not grow as the burr comes near";
}

TEST(EffectText, HeatWarnsBeforeItHarms) {
    EffectState state;
    const auto toneAt = [&](double celsius, uint32_t events) {
        state.set_temperature_c(celsius);
        return effectTaskRows(state, nullptr, events).at(0).tone;
    };
    EXPECT_EQ(toneAt(41.9, 0), HudTone::kPlain);
    EXPECT_EQ(toneAt(42, 0), HudTone::kWarning);
    EXPECT_EQ(toneAt(47.5, EffectState::TOO_HOT), HudTone::kAlarm);
}

TEST(EffectText, TheNearestStructureByNameAndDistance) {
    const topics::SceneInfo info = infoWithNerve();
    EffectState state;
    state.set_protected_id(2);
    const auto rowAt = [&](double distance_m, uint32_t events) {
        state.set_protected_distance_m(distance_m);
        return effectTaskRows(state, &info, events).at(0);
    };
    EXPECT_EQ(rowAt(4.2e-3, 0).label, "facial nerve");
    EXPECT_EQ(rowAt(4.2e-3, 0).value, "4.20 mm");
    EXPECT_EQ(rowAt(4.2e-3, 0).tone, HudTone::kPlain);
    EXPECT_EQ(rowAt(1e-3, EffectState::NEAR_PROTECTED).tone, HudTone::kWarning);
    EXPECT_EQ(rowAt(1e-3, EffectState::PROTECTED_TOUCHED).tone, HudTone::kAlarm) << "a moment ago";
    EXPECT_EQ(rowAt(-1e-4, 0).value, "touched");
    EXPECT_EQ(rowAt(-1e-4, 0).tone, HudTone::kAlarm);
    EXPECT_EQ(structureName(3, &info), "material 3");
    EXPECT_EQ(structureName(4, &info), "protected") << "a server may name what it never described";
    EXPECT_EQ(structureName(2, nullptr), "protected");
}

TEST(EffectText, TheWorstOfWhatHappenedIsTheAlert) {
    const topics::SceneInfo info = infoWithNerve();
    const auto textOf = [&](uint32_t events) {
        const auto alert = effectAlert(events, 2, &info);
        return alert ? alert->text : "";
    };
    EXPECT_EQ(textOf(0), "");
    EXPECT_EQ(textOf(EffectState::SPINDLE_STALLED), "") << "harms nobody";
    EXPECT_EQ(textOf(EffectState::NEAR_PROTECTED), "Near facial nerve");
    EXPECT_EQ(effectAlert(EffectState::NEAR_PROTECTED, 2, &info)->tone, HudTone::kWarning);
    EXPECT_EQ(textOf(EffectState::NEAR_PROTECTED | EffectState::PROTECTED_TOUCHED), "Touches facial nerve");
    EXPECT_EQ(textOf(EffectState::PROTECTED_DAMAGED | EffectState::PROTECTED_TOUCHED),
              "Damages facial nerve");
    EXPECT_EQ(textOf(EffectState::TOO_HOT), "Bone too hot");
    EXPECT_EQ(textOf(EffectState::NEAR_PROTECTED | EffectState::TOO_HOT), "Near facial nerve, bone too hot");
    EXPECT_EQ(effectAlert(EffectState::NEAR_PROTECTED | EffectState::TOO_HOT, 2, &info)->tone,
              HudTone::kAlarm);
}

TEST(EffectText, TrainingInWords) {
    EXPECT_TRUE(trainingRows({}).empty());
    topics::Training training;
    training.set_damaged_mm3(0);
    training.set_least_distance_mm(-0.2);
    training.set_max_temperature_c(45);
    training.add_warnings("touched facial nerve");
    const std::vector<HudRow> rows = trainingRows(training);
    EXPECT_EQ(test::findRow(rows, "Damaged")->value, "none");
    EXPECT_EQ(test::findRow(rows, "Least distance to a protected structure")->tone, HudTone::kAlarm);
    training.set_nearest_structure("facial nerve");
    EXPECT_TRUE(test::findRow(trainingRows(training), "Least distance to facial nerve"));
    EXPECT_EQ(test::findRow(rows, "Hottest bone so far")->tone, HudTone::kWarning);
    EXPECT_EQ(test::findRow(rows, "Necrosis"), nullptr);
    EXPECT_EQ(rows.back().value, "touched facial nerve");
}

// An event of a single tick is seen for half a second, counted from the first picture that shows it.
TEST(EventLatch, ShowsEachEventLongEnough) {
    EventLatch latch;
    const EventLatch::Clock::time_point start{10s};
    EXPECT_EQ(latch.show(start), 0u);
    latch.note(4);
    EXPECT_EQ(latch.show(start + 3s), 4u) << "however late the picture comes";
    EXPECT_EQ(latch.show(start + 3499ms), 4u);
    EXPECT_EQ(latch.show(start + 3500ms), 0u);
    latch.note(1u << 31 | 2);
    EXPECT_EQ(latch.show(start + 4s), 1u << 31 | 2);
    latch.note(2);
    EXPECT_EQ(latch.show(start + 4400ms), 1u << 31 | 2);
    EXPECT_EQ(latch.show(start + 4600ms), 2u) << "each for itself";
    EXPECT_EQ(latch.show(start + 4900ms), 0u);
}

}  // namespace
}  // namespace bonemill
