#include "haptic_server/assessment/measures/strokes.h"

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "tests/unit/haptic_server/assessment/measures/hand_made_session.h"

namespace bonemill {
namespace {

using test::HandMadeSession;
using test::kPi;
using test::valueOf;

// To and fro along x once per second, 10 mm each way, milling all the time with 2 N.
HandMadeSession toAndFro() {
    HandMadeSession session;
    session.seconds = 10;
    session.place = [](double t) { return Eigen::Vector3d(-5e-3 * std::cos(2 * kPi * t), 0, 0); };
    session.contact = [](double) { return true; };
    session.force = [](double) { return 2.0; };
    session.removed_until = [](double t) { return 1e-9 * t; };
    return session;
}

TEST(Strokes, ToAndFroAreTwoStrokesPerSecond) {
    const Figures figures = toAndFro().figures();
    EXPECT_NEAR(valueOf(figures, "strokes.turns"), 20, 1);
    EXPECT_NEAR(valueOf(figures, "strokes.turns.length"), 10, 0.3);
    EXPECT_NEAR(valueOf(figures, "strokes.turns.time"), 0.5, 0.021);
    EXPECT_NEAR(valueOf(figures, "strokes.turns.speed"), 20, 0.8);
    EXPECT_NEAR(valueOf(figures, "strokes.turns.force"), 2, 0.01);
    EXPECT_NEAR(valueOf(figures, "strokes.turns.volume"), 0.5, 0.03);
    EXPECT_EQ(valueOf(figures, "strokes.bouts"), 1);
    EXPECT_NEAR(valueOf(figures, "strokes.bouts.time"), 10, 0.06);
}

// A turn of a hand that goes to and fro every other second is slow for 96 ms, of one every second for 48 ms.
TEST(Strokes, MinimaOfSpeedMustLast) {
    HandMadeSession session = toAndFro();
    EXPECT_EQ(valueOf(session.figures(), "strokes.minima"), 1);
    session.place = [](double t) { return Eigen::Vector3d(-5e-3 * std::cos(kPi * t), 0, 0); };
    EXPECT_NEAR(valueOf(session.figures(), "strokes.minima"), 10, 1);
    EXPECT_NEAR(valueOf(session.figures(), "strokes.minima.length"), 10, 0.5);
}

// Half a sine of speed; its spectrum is known to have no more than one hump.
TEST(Strokes, AStrokeIsAsSmoothAsItsSpeed) {
    const Figures figures = toAndFro().figures();
    EXPECT_GT(valueOf(figures, "smooth.sparc"), -1.6);
    EXPECT_LT(valueOf(figures, "smooth.sparc"), -1.3);
    EXPECT_LT(valueOf(figures, "smooth.f95"), 2.5);
}

TEST(Strokes, WayWithoutRemovalIsNoStroke) {
    HandMadeSession session = toAndFro();
    session.removed_until = [](double t) { return 1e-9 * std::min(t, 5.0); };
    EXPECT_NEAR(valueOf(session.figures(), "strokes.turns"), 10, 1);
}

TEST(Strokes, AHandThatTremblesOnTheSpotMakesNone) {
    HandMadeSession session = toAndFro();
    session.place = [](double t) { return Eigen::Vector3d(1e-4 * std::sin(2 * kPi * 3 * t), 0, 0); };
    EXPECT_EQ(valueOf(session.figures(), "strokes.turns"), 0);
}

TEST(Strokes, ARoundWayHasNoTurns) {
    HandMadeSession session = toAndFro();
    session.place = [](double t) {
        return Eigen::Vector3d(5e-3 * std::cos(2 * kPi * t), 5e-3 * std::sin(2 * kPi * t), 0);
    };
    EXPECT_EQ(valueOf(session.figures(), "strokes.turns"), 1);
    EXPECT_NEAR(valueOf(session.figures(), "strokes.turns.length"), 100 * kPi, 2);
}

TEST(Strokes, ContactsArePartedByATenthOfASecond) {
    HandMadeSession session;
    session.seconds = 3;
    // two short gaps of 80 ms, then one of 300 ms
    const auto is_off = [](double t) {
        return (t > 0.5 && t < 0.58) || (t > 1 && t < 1.08) || (t > 1.5 && t < 1.8) || t > 2.8;
    };
    session.force = [=](double t) { return is_off(t) ? 0.02 : 0.5; };
    session.contact = [](double) { return true; };
    const Figures figures = session.figures();
    EXPECT_EQ(valueOf(figures, "strokes.bouts"), 2);
    EXPECT_NEAR(valueOf(figures, "strokes.bouts.time"), 1.0, 0.02);
}

TEST(Strokes, AForceBetweenTheLimitsNeitherBeginsNorEndsAContact) {
    HandMadeSession session;
    session.contact = [](double) { return true; };
    session.force = [](double) { return 0.07; };
    EXPECT_EQ(valueOf(session.figures(), "strokes.bouts"), 0);
    session.force = [](double t) { return t < 0.2 ? 0.2 : 0.07; };
    EXPECT_EQ(valueOf(session.figures(), "strokes.bouts"), 1);
    EXPECT_NEAR(valueOf(session.figures(), "strokes.bouts.time"), 1, 0.01);
}

TEST(StrokeList, KeepsABoundedNumberAndCountsAll) {
    StrokeList strokes;
    StrokeMeasures stroke;
    for (size_t n = 0; n < StrokeList::kMaxKept + 10; ++n) {
        stroke.length = double(n % 3);
        strokes.add(stroke);
    }
    EXPECT_EQ(strokes.count(), StrokeList::kMaxKept + 10);
    EXPECT_EQ(strokes.kept().size(), StrokeList::kMaxKept);
    EXPECT_EQ(strokes.median(&StrokeMeasures::length), 1);
    EXPECT_TRUE(std::isnan(strokes.median(&StrokeMeasures::sparc)));
}

}  // namespace
}  // namespace bonemill
