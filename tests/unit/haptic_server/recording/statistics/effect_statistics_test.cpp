#include "haptic_server/recording/statistics/effect_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace bonemill {
namespace {

constexpr RecordedEffects kAll{.burr = true, .heat = true, .protection = true};

std::map<std::string, double> figuresOf(const EffectStatistics& statistics) {
    std::map<std::string, double> figures;
    for (const auto& [figure, value] : statistics.figures()) figures[figure->run.key] = value;
    return figures;
}

EffectRecord nearNerve(float distance, uint32_t events) {
    EffectRecord record{};
    record.protected_id = record.touched_id = record.damaged_id = 2;
    record.protected_distance = distance;
    record.events = events;
    return record;
}

TEST(EffectStatistics, OnlyWhatIsRecordedIsTold) {
    EXPECT_TRUE(figuresOf(EffectStatistics()).empty());
    EXPECT_TRUE(figuresOf(EffectStatistics({.burr = true})).contains("axis_torque_max_nm"));
    EXPECT_FALSE(figuresOf(EffectStatistics({.burr = true})).contains("necrotic_mm3"));
    EXPECT_TRUE(figuresOf(EffectStatistics({.heat = true})).contains("necrotic_mm3"));
    EXPECT_FALSE(figuresOf(EffectStatistics({.heat = true})).contains("protected_damaged_mm3"));
}

TEST(EffectStatistics, ExtremesAndTotalsOfARun) {
    EffectStatistics statistics(kAll);
    EffectRecord record{};
    record.axis_torque = -3e-3f;
    record.cutting_power = 12;
    record.removed_energy = 0.25f;
    record.temperature = 51;
    record.necrotic_volume = 2e-9f;
    record.protected_force = 0.5f;
    record.damaged_volume = 1e-9f;
    statistics.add(record);
    record.axis_torque = 1e-3f;
    record.temperature = 40;
    record.necrotic_volume = 3e-9f;
    record.events = kEventSpindleStalled;
    statistics.add(record);
    const auto figures = figuresOf(statistics);
    EXPECT_FLOAT_EQ(float(figures.at("axis_torque_max_nm")), 3e-3f);
    EXPECT_EQ(figures.at("cutting_power_max_w"), 12);
    EXPECT_EQ(figures.at("removed_energy_j"), 0.5);
    EXPECT_EQ(figures.at("spindle_stalled_ticks"), 1);
    EXPECT_EQ(figures.at("temperature_max_c"), 51);
    EXPECT_FLOAT_EQ(float(figures.at("necrotic_mm3")), 3);
    EXPECT_EQ(figures.at("protected_force_max_n"), 0.5);
    EXPECT_FLOAT_EQ(float(figures.at("protected_damaged_mm3")), 1);
    EXPECT_FALSE(figures.contains("protected_distance_min_mm")) << "no structure was in reach";
}

TEST(EffectStatistics, TheLeastDistanceIsOfStructuresInReach) {
    EffectStatistics statistics(kAll);
    EffectRecord none{};
    none.protected_distance = -1;  // says nothing without a structure
    statistics.add(none);
    statistics.add(nearNerve(2e-3f, 0));
    statistics.add(nearNerve(-0.5e-3f, 0));
    statistics.add(nearNerve(1e-3f, 0));
    statistics.add(nearNerve(std::nanf(""), 0));
    EXPECT_NEAR(figuresOf(statistics).at("protected_distance_min_mm"), -0.5, 1e-6);
}

TEST(EffectStatistics, TheLeastDistanceIsOfAStructureWithAName) {
    const std::vector<std::string> materials{"bone", "facial nerve", "dura"};
    EffectStatistics statistics(kAll);
    EXPECT_EQ(statistics.nearest(materials), "");
    for (const auto& [id, distance] : {std::pair(3, 2e-3f), {2, 1e-3f}, {3, 1.5e-3f}, {3, 1e-3f}}) {
        EffectRecord record{};
        record.protected_id = uint32_t(id);
        record.protected_distance = distance;
        statistics.add(record);
    }
    EXPECT_EQ(statistics.nearest(materials), "facial nerve") << "the first that was so near";
}

TEST(EffectStatistics, EachWarningOnceTheWorstFirst) {
    EffectStatistics statistics(kAll);
    EXPECT_TRUE(statistics.warnings({}).empty());
    for (int n = 0; n < 3; ++n) {
        statistics.add(nearNerve(1e-3f, kEventNearProtected));
        statistics.add(nearNerve(0, kEventNearProtected | kEventProtectedTouched));
        statistics.add(nearNerve(0, kEventProtectedDamaged | kEventTooHot));
    }
    EffectRecord other = nearNerve(1e-3f, kEventNearProtected);
    other.protected_id = 3;
    statistics.add(other);
    const std::vector<std::string> expected{"damaged facial nerve", "touched facial nerve",
                                            "came near facial nerve", "came near material 3", "bone too hot"};
    EXPECT_EQ(statistics.warnings({"bone", "facial nerve", ""}), expected);
    EXPECT_EQ(statistics.warnings({}).front(), "damaged a protected structure");
}

// The shaft lies on one structure while the burr is nearest to another.
TEST(EffectStatistics, WarningsNameWhatWasTouchedNotWhatIsNearest) {
    EffectStatistics statistics(kAll);
    EffectRecord record = nearNerve(1e-3f, kEventNearProtected | kEventProtectedTouched);
    record.touched_id = 1;
    statistics.add(record);
    const std::vector<std::string> expected{"touched dural sac", "came near facial nerve"};
    EXPECT_EQ(statistics.warnings({"dural sac", "facial nerve"}), expected);
}

}  // namespace
}  // namespace bonemill
