#include <gtest/gtest.h>

#include <random>

#include "tests/unit/haptic_server/assessment/measures/hand_made_session.h"

namespace bonemill {
namespace {

using test::HandMadeSession;
using test::kPi;

// Somebody mills: strokes of random lengths and speeds with random pressure, contact in most of them.
HandMadeSession randomMilling(uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0, 1);
    const double stroke_hz = 0.5 + share(random), amplitude = 2e-3 + 6e-3 * share(random);
    const double drift = 1e-3 * share(random), press = 1 + 3 * share(random), press_hz = 0.1 + share(random);
    const double tremor = 1e-5 * share(random), rate = 1e-9 * (0.5 + share(random));
    HandMadeSession session;
    session.seconds = 20;
    session.place = [=](double t) {
        return Eigen::Vector3d(amplitude * std::sin(2 * kPi * stroke_hz * t), drift * t,
                               tremor * std::sin(2 * kPi * 9 * t));
    };
    session.force = [=](double t) { return press * (1 + 0.5 * std::sin(2 * kPi * press_hz * t)); };
    session.contact = [](double t) { return std::fmod(t, 5.0) > 0.7; };
    session.removed_until = [=](double t) { return rate * t; };
    session.more = [](double t, TickRecord& record) {
        record.effects.protected_id = 1;
        record.effects.protected_distance = float(3e-3 + 2.5e-3 * std::sin(0.7 * t));
        record.effects.temperature = float(44 + 3 * std::sin(0.3 * t));
        record.effects.burr_force = float(record.contacts ? record.f_hand_W[1] : 0);
    };
    return session;
}

class Rates : public testing::TestWithParam<uint32_t> {};

// A loop of 4 kHz and one of 1 kHz, or one whose ticks are late by chance, see the same hand.
TEST_P(Rates, FiguresDoNotDependOnTheRateOfTheLoop) {
    TechniqueScene scene;
    scene.recorded = {true, true, true};
    scene.materials = {"nerve"};
    scene.tools = {"ball"};
    scene.force_limit = 4;
    HandMadeSession session = randomMilling(GetParam());
    const Figures at_1_khz = session.figures(scene);
    session.rate = 4000;
    const Figures at_4_khz = session.figures(scene);
    std::mt19937 random(GetParam());
    std::bernoulli_distribution is_dropped(0.2);
    Technique with_gaps(scene);
    session.play([&](const TickRecord& record) {
        if (!is_dropped(random) || record.removed != 0) with_gaps.add(record);
    });
    with_gaps.finish();
    const Figures dropped = with_gaps.figures();
    ASSERT_GT(at_1_khz.size(), 40);
    ASSERT_EQ(at_1_khz.size(), at_4_khz.size());
    for (const Figure& figure : at_1_khz) {
        const double slack = 0.02 * std::abs(figure.value) + 0.02;
        EXPECT_NEAR(test::valueOf(at_4_khz, figure.id), figure.value, slack) << figure.id;
        EXPECT_NEAR(test::valueOf(dropped, figure.id), figure.value, slack) << figure.id;
    }
}
INSTANTIATE_TEST_SUITE_P(Hands, Rates, testing::Range(1u, 9u));

}  // namespace
}  // namespace bonemill
