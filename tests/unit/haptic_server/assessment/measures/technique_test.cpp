#include "haptic_server/assessment/measures/technique.h"

#include <gtest/gtest.h>

#include <ctime>

#include "common/base/units.h"
#include "tests/unit/haptic_server/assessment/measures/hand_made_session.h"

namespace bonemill {
namespace {

using test::HandMadeSession;
using test::kPi;
using test::valueOf;

// 10 s at 20 mm/s along x, in contact from 2 s to 7 s with 3 N, the pedal down from 1 s to 8 s.
HandMadeSession straightWay() {
    HandMadeSession session;
    session.seconds = 10;
    session.place = [](double t) { return Eigen::Vector3d(0.02 * t, 0, 0); };
    session.contact = [](double t) { return t > 2 && t <= 7; };
    session.force = [](double t) { return t > 2 && t <= 7 ? 3.0 : 0.0; };
    session.more = [](double t, TickRecord& record) {
        record.buttons = t > 1 && t <= 8 ? uint32_t(kButtonRemove) : 0;
    };
    return session;
}

TEST(Technique, TimesOfAStraightWayAreThoseThatItWasMadeOf) {
    const Figures figures = straightWay().figures();
    EXPECT_NEAR(valueOf(figures, "time.session"), 10, 1e-9);
    EXPECT_NEAR(valueOf(figures, "time.pedal"), 7, 2e-3);
    EXPECT_NEAR(valueOf(figures, "time.contact"), 5, 2e-3);
    EXPECT_NEAR(valueOf(figures, "time.idle"), 5, 2e-3);
    EXPECT_EQ(findFigure(figures, "time.lost"), nullptr);
}

TEST(Technique, TheWayIsAsLongAsItIs) {
    const Figures figures = straightWay().figures();
    EXPECT_NEAR(valueOf(figures, "path.length"), 200, 1);
    EXPECT_NEAR(valueOf(figures, "path.contact"), 100, 1);
    EXPECT_EQ(findFigure(figures, "path.per_volume"), nullptr) << "nothing was removed";
}

TEST(Technique, ASineOfForceHasItsMeanMedianTailAndImpulse) {
    HandMadeSession session;
    session.seconds = 20;
    session.contact = [](double) { return true; };
    session.force = [](double t) { return 2 + std::sin(2 * kPi * t); };
    TechniqueScene scene;
    scene.force_limit = 2 + std::sin(kPi / 6);  // 1/3 of a turn is above
    const Figures figures = session.figures(scene);
    EXPECT_NEAR(valueOf(figures, "force.mean"), 2, 1e-3);
    EXPECT_NEAR(valueOf(figures, "force.median"), 2, 0.02);
    EXPECT_NEAR(valueOf(figures, "force.p95"), 2 + std::sin(0.45 * kPi), 0.02);
    EXPECT_NEAR(valueOf(figures, "force.max"), 3, 1e-4);
    EXPECT_NEAR(valueOf(figures, "force.impulse"), 40, 0.01);
    EXPECT_NEAR(valueOf(figures, "force.excess"), 100.0 / 3, 0.3);
}

TEST(Technique, WithoutContactThereIsNoForceToTellOf) {
    HandMadeSession session;
    session.force = [](double) { return 1.0; };
    const Figures figures = session.figures();
    EXPECT_EQ(findFigure(figures, "force.mean"), nullptr);
    EXPECT_EQ(findFigure(figures, "force.max"), nullptr);
    EXPECT_NEAR(valueOf(figures, "time.idle"), 1, 1e-9);
}

TEST(Technique, RemovalHasItsRateWorkAndBurr) {
    HandMadeSession session;
    session.seconds = 10;
    session.contact = [](double t) { return t > 2 && t <= 6; };
    session.force = [](double) { return 1.0; };
    // 2 mm³/s from 2 s to 6 s, the last second of them with the other burr
    session.removed_until = [](double t) { return 2e-9 * std::clamp(t - 2, 0.0, 4.0); };
    session.more = [](double t, TickRecord& record) {
        record.tool = t > 5 ? 1 : 0;
        record.effects.cutting_power = t > 2 && t <= 6 ? 3 : 0;
    };
    TechniqueScene scene;
    scene.recorded.burr = true;
    scene.tools = {"ball", "cone"};
    const Figures figures = session.figures(scene);
    EXPECT_NEAR(valueOf(figures, "removal.volume"), 8, 1e-9);
    EXPECT_NEAR(valueOf(figures, "time.cutting"), 4, 0.03);
    EXPECT_NEAR(valueOf(figures, "removal.rate"), 2, 0.02);
    EXPECT_NEAR(valueOf(figures, "removal.friction_energy"), 12.0 / 8, 2e-3);
    EXPECT_NEAR(valueOf(figures, "burr.share:ball"), 75, 0.1);
    EXPECT_NEAR(valueOf(figures, "burr.volume:cone"), 2, 0.01);
    EXPECT_NEAR(valueOf(figures, "angle.normal"), 0, 0.1);  // the force is along the shaft
    EXPECT_NEAR(valueOf(figures, "angle.side_share"), 0, 1e-9);
}

TEST(Technique, AShaftAcrossTheForceCutsWithTheSide) {
    HandMadeSession session;
    session.contact = [](double) { return true; };
    session.removed_until = [](double t) { return 1e-9 * t; };
    session.more = [](double t,
                      TickRecord& record) {  // the first half at 60°, the rest at 30° from the force
        const double angle = (t > 0.5 ? 30 : 60) * kDegree;
        record.f_hand_W[0] = std::sin(angle);
        record.f_hand_W[1] = std::cos(angle);
    };
    const Figures figures = session.figures();
    EXPECT_NEAR(valueOf(figures, "angle.side_share"), 50, 0.2);
}

TEST(Technique, LostTicksAreCountedAndMeasureNothing) {
    Technique technique({});
    HandMadeSession session = straightWay();
    session.play([&](const TickRecord& record) {
        if (record.t_s < 4 || record.t_s > 5) technique.add(record);
    });
    technique.finish();
    const Figures figures = technique.figures();
    EXPECT_NEAR(valueOf(figures, "time.lost"), 1, 0.01);
    EXPECT_NEAR(valueOf(figures, "time.session"), 9, 0.01);
    EXPECT_NEAR(valueOf(figures, "time.contact"), 4, 0.01);
    EXPECT_NEAR(valueOf(figures, "path.length"), 180, 2);
}

TEST(Technique, AShaftThatSwingsHasThatMuchUnrest) {
    HandMadeSession session;
    session.seconds = 10;
    session.contact = [](double) { return true; };
    session.force = [](double t) { return 2 + 0.3 * std::sin(4 * kPi * t); };
    const double swing = 3 * kDegree;  // amplitude, about z, twice per second
    session.more = [swing](double t, TickRecord& record) {
        const double half = 0.5 * swing * std::sin(4 * kPi * t);
        record.q_WT[0] = std::cos(half), record.q_WT[3] = std::sin(half);
    };
    const Figures figures = session.figures();
    EXPECT_NEAR(valueOf(figures, "steady.axis"), 3 / std::sqrt(2), 0.05);
    EXPECT_NEAR(valueOf(figures, "steady.force"), 0.3 / std::sqrt(2), 0.01);
}

TEST(Technique, SecondsAndBucketsAddUpToTheWhole) {
    HandMadeSession session = straightWay();
    session.begin_s = 100;
    session.removed_until = [](double t) { return 2e-9 * std::clamp(t - 2, 0.0, 5.0); };
    Technique technique({});
    session.measure(technique);
    const std::vector<SeriesTable> tables = technique.series();
    ASSERT_EQ(tables.size(), 2);
    const auto sumOf = [](const SeriesTable& table, const std::string& id) {
        double sum = 0;
        for (const Series& column : table.columns)
            if (column.id == id)
                for (const double value : column.values) sum += value;
        return sum;
    };
    EXPECT_EQ(tables[0].index.values.size(), 11);
    EXPECT_EQ(tables[1].index.values.size(), Technique::kBuckets);
    for (const SeriesTable& table : tables) {
        EXPECT_NEAR(sumOf(table, "removed"), 10, 1e-6) << table.id;
        EXPECT_NEAR(sumOf(table, "contact"), 5, 2e-3) << table.id;
        EXPECT_NEAR(sumOf(table, "path"), 200, 1) << table.id;
        EXPECT_NEAR(sumOf(table, "time"), 10, 1e-6) << table.id;
    }
    for (const Series& column : tables[1].columns) {
        if (column.id != "removed") continue;
        for (const double value : column.values) EXPECT_NEAR(value, 2, 0.02);
    }
}

TEST(Technique, TheHardestPressOfEachContactIsAMoment) {
    HandMadeSession session;
    session.seconds = 6;
    session.begin_s = 50;
    session.contact = [](double t) { return (t > 1 && t < 2) || (t > 4 && t < 5); };
    session.force = [](double t) { return t > 4 ? 8 - 16 * std::abs(t - 4.5) : 4 - 8 * std::abs(t - 1.5); };
    TechniqueScene scene;
    scene.force_limit = 5;
    Technique technique(scene);
    session.measure(technique);
    const std::vector<Moment> moments = technique.moments();
    ASSERT_EQ(moments.size(), 2);
    EXPECT_NEAR(moments[0].t_s, 51.5, 2e-3);
    EXPECT_NEAR(moments[1].t_s, 54.5, 2e-3);
    EXPECT_NEAR(moments[1].severity, 8.0 / 5, 0.01);
    EXPECT_EQ(worstOf(moments, 1)[0].t_s, moments[1].t_s);
    EXPECT_EQ(moments[1].text, "8 N on the bone");
}

TEST(Technique, WhatTheBurrLiesOnAtTheBeginningIsNoMoment) {
    HandMadeSession session;
    session.seconds = 6;
    session.contact = [](double t) { return t < 1 || t > 3; };
    session.force = [](double t) { return t < 1 ? 9 : t < 4 ? 0.1 : 2; };
    Technique technique({});
    session.measure(technique);
    const std::vector<Moment> moments = technique.moments();
    ASSERT_EQ(moments.size(), 1);
    EXPECT_EQ(moments[0].text, "2 N on the bone");
    session.force = [](double) { return 0.1; };
    Technique gentle({});
    session.measure(gentle);
    EXPECT_TRUE(gentle.moments().empty());
}

// docs/measurements.md has what --gtest_output=xml tells of it.
TEST(Technique, AnHourTakesNoMoreMemoryThanItsTables) {
    HandMadeSession session;
    session.seconds = 3600;
    session.rate = 200;
    session.place = [](double t) { return Eigen::Vector3d(5e-3 * std::sin(6 * t), 1e-3 * std::sin(t), 0); };
    session.contact = [](double t) { return std::fmod(t, 3) > 1; };
    session.force = [](double t) { return 2 + std::sin(t); };
    session.removed_until = [](double t) { return 1e-9 * t; };
    Technique technique({});
    double ticks = 0;
    std::clock_t spent = 0;
    session.play([&](const TickRecord& record) {
        const std::clock_t start = std::clock();
        technique.add(record);
        spent += std::clock() - start;
        ++ticks;
    });
    technique.finish();
    RecordProperty("ns_per_tick", int(1e9 * double(spent) / CLOCKS_PER_SEC / ticks));
    RecordProperty("bytes", int(sizeof(Technique)));
    const std::vector<SeriesTable> tables = technique.series();
    EXPECT_LE(tables[0].index.values.size(), StepTable::kMaxRows);
    EXPECT_NEAR(tables[0].index.values.back(), 3600, 4);
    EXPECT_LE(technique.moments().size(), WorstMoments::kMaxKept);
    EXPECT_LE(sizeof(Technique), size_t(512) << 10);
    EXPECT_NEAR(valueOf(technique.figures(), "time.contact"), 2400, 10);
    EXPECT_GT(technique.strokes().strokes().count(), 6000);
}

TEST(Technique, AnAttemptWithoutATickHasNoMeasures) {
    Technique technique({});
    EXPECT_TRUE(technique.isEmpty());
    technique.finish();
    const Figures figures = technique.figures();
    EXPECT_EQ(valueOf(figures, "time.session"), 0);
    EXPECT_EQ(findFigure(figures, "force.mean"), nullptr);
    EXPECT_TRUE(technique.moments().empty());
}

}  // namespace
}  // namespace bonemill
