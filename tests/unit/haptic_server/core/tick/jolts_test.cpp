// Discrete events under a resting or slow hand: the force goes on, the tool stays on its side, and all is as
// it was half a second later. The events are those of the bench (tests/stability/jolts.h).
#include "tests/stability/jolts.h"

#include <gtest/gtest.h>

#include <ostream>

#include "tests/stability/hard_scenes.h"
#include "tests/stability/jolt_bench.h"

namespace bonemill::test {
namespace {

constexpr double kMaxJolt = 0.3;      // N per tick
constexpr double kMaxRecovery = 0.5;  // s

struct JoltTrial {
    JoltEvent event;
    Variant variant;
};
void PrintTo(const JoltTrial& trial, std::ostream* out) {
    *out << trial.event.name << ' ' << trial.variant.name;
}

class Jolts : public testing::TestWithParam<JoltTrial> {};

TEST_P(Jolts, AreNotFeltAndPassSoon) {
    const JoltFigures figures = GetParam().event.run(GetParam().variant);
    EXPECT_TRUE(figures.is_finite);
    EXPECT_LE(figures.jolt, kMaxJolt);
    EXPECT_TRUE(figures.on_side);
    EXPECT_LE(figures.recovery, kMaxRecovery);
}

// Every event with the default preset, and with the other two those in which the contact itself decides.
std::vector<JoltTrial> joltTrials() {
    std::vector<JoltTrial> trials;
    for (const Variant& variant : joltVariants()) {
        if (variant.isBaseline() || variant.isOtherLaw()) continue;
        for (const JoltEvent& event : joltEvents()) {
            const std::string name = event.name;
            const bool is_contacts = name == "buried_drawn_out" || name == "pulled_across_needle" ||
                                     name == "growing_burr" || name == "pedal_time_removal";
            if (variant.preset == Preset::kBalanced || is_contacts) trials.push_back({event, variant});
        }
    }
    return trials;
}
INSTANTIATE_TEST_SUITE_P(Gradient, Jolts, testing::ValuesIn(joltTrials()),
                         [](const testing::TestParamInfo<JoltTrial>& info) {
                             return std::string(info.param.event.name) + "_" + info.param.variant.name;
                         });

// A burr that was drawn out of solid bone is small at first. Pressed on the face again it is as before.
TEST(JoltAfterwards, ABurrThatWasDrawnOutOfBoneIsSoonWholeAgain) {
    const Eigen::Vector3d face(4e-3, 4e-3, 4e-3), up(0, 0, 1);
    const auto bone = [&] { return bodyVolume(boxOf({8e-3, 8e-3, 5e-3}), halfSpace(face, up)); };
    const auto pressed = [&](double from) {
        JoltBench bench(bone(), joltVariants().front(), face + from * up);
        const double above = 1.5 * kBurrRadius;
        bench.run(500, 2 * (above - from) * up);
        bench.run(100);
        bench.run(500, -2 * (above - 0.5 * kBurrRadius) * up);
        bench.run(300);
        return bench.stepper().wrenchOnHand().force.z();
    };
    const double never_buried = pressed(1.2 * kBurrRadius), was_buried = pressed(-2.2 * kBurrRadius);
    EXPECT_GT(never_buried, 1);
    EXPECT_NEAR(was_buried, never_buried, 0.02 * never_buried);
}

}  // namespace
}  // namespace bonemill::test
