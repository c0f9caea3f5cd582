// Runs haptic_server --scene FILE --describe-scene.
#include <gtest/gtest.h>

#include "tests/support/process.h"

namespace bonemill {
namespace {

class DescribeScene : public testing::Test {
  protected:
    DescribeScene() {
        const auto made =
            test::run({"make_phantom", "body", "--kind", "sphere", "--out", folder_ / "ball.nrrd"});
        EXPECT_EQ(made.exit_code, 0) << made.err;
    }
    std::string describe(const std::string& more) {
        test::writeFile(folder_ / "scene.textproto", "volume { path: \"ball.nrrd\" } " + more);
        const auto finished =
            test::run({"haptic_server", "--scene", folder_ / "scene.textproto", "--describe-scene"});
        EXPECT_EQ(finished.exit_code, 0) << finished.err;
        return finished.out;
    }
    void expectLine(const std::string& text, const std::string& line) {
        EXPECT_NE(text.find("\n" + line + "\n"), std::string::npos) << line << " in:\n" << text;
    }

    test::TemporaryFolder folder_;
};

TEST_F(DescribeScene, SaysHowMuchATickMayDo) {
    const std::string at_1_khz = describe("");
    expectLine(at_1_khz, "most point tests in a tick: 100000");
    expectLine(at_1_khz, "most milled cells in a tick: 75000");
    const std::string at_4_khz = describe("loop { rate_hz: 4000 }");
    expectLine(at_4_khz, "most point tests in a tick: 25000");
    expectLine(at_4_khz, "most milled cells in a tick: 18750");
}

constexpr const char* kPress =
    " simulated_operator { waypoint { time_s: 0 p_WT_mm { z: 5 } } waypoint { time_s: 1 p_WT_mm { z: 4.95 } "
    "remove: true } "
    "waypoint { time_s: 2 p_WT_mm { z: 4.95 } } }";

TEST_F(DescribeScene, SaysWhatEachListedEffectIsAndCosts) {
    const std::string text =
        describe(std::string("effects { time_removal { rate_density_per_s: 700 } bone_dust {} }") + kPress);
    const size_t effects = text.find("\neffects:\n");
    ASSERT_NE(effects, std::string::npos) << text;
    const std::string plan = text.substr(effects, text.find("\ncost per tick") - effects);
    EXPECT_NE(plan.find("\n  time_removal: rate_density_per_s 700; adds p50 "), std::string::npos) << plan;
    EXPECT_NE(plan.find("\n  bone_dust"), std::string::npos) << plan;
    EXPECT_NE(plan.find("; in the viewer\n"), std::string::npos) << plan;
    EXPECT_NE(plan.find("\n  all of them: p50 "), std::string::npos) << plan;
    for (const char* other : {"add_material", "energy_removal", "spindle", "thermal", "material"})
        EXPECT_EQ(plan.find(other), std::string::npos) << other << " in: " << plan;
}

TEST_F(DescribeScene, WithoutEffectsSaysSo) {
    expectLine(describe(kPress), "effects: none");
}

// Without a way to follow there is nothing to measure.
TEST_F(DescribeScene, WithoutWaypointsListsTheEffectsOnly) {
    expectLine(describe("effects { add_material {} }"), "  add_material: rate_density_per_s 12750");
}

TEST_F(DescribeScene, ListsTheTools) {
    const std::string text = describe("tool { } tool { name: \"fine\" burr_radius_mm: 0.5 }");
    EXPECT_NE(text.find("\ntool 1 'tool 1', in use at the start: "), std::string::npos) << text;
    EXPECT_NE(text.find("\ntool 2 'fine': "), std::string::npos) << text;
    EXPECT_NE(text.find("burr radius 0.5 mm"), std::string::npos) << text;
}

TEST_F(DescribeScene, TheThesisLawHasNoBudgetOfPointTests) {
    expectLine(describe("accuracy { preset: THESIS_2012 }"),
               "most point tests in a tick: 100000, without effect on this law");
}

}  // namespace
}  // namespace bonemill
