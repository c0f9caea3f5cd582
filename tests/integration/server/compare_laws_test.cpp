// deploy/compare-laws: laws on one way of the hand, as simulate runs each.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

constexpr const char* kSlabScene =
    "name: \"slab\" effects { time_removal {} } volume { path: \"slab.nrrd\" }\n"
    "simulated_operator {\n"
    "  waypoint { time_s: 0 p_WT_mm { x: 0.03 y: -0.08 z: 3.1 } q_WT { w: 1 } }\n"
    "  waypoint { time_s: 0.1 p_WT_mm { x: 0.03 y: -0.08 z: 2.8 } q_WT { w: 1 } remove: true }\n"
    "  waypoint { time_s: 0.5 p_WT_mm { x: 0.03 y: -0.08 z: 2.5 } q_WT { w: 1 } }\n"
    "}\n";

class CompareLaws : public testing::Test {
  protected:
    CompareLaws() {
        EXPECT_EQ(
            test::run({"make_phantom", "body", "--kind", "slab", "--out", folder_ / "slab.nrrd"}).exit_code,
            0);
        test::writeFile(scene(), kSlabScene);
    }
    std::string scene() const { return folder_ / "s.textproto"; }
    std::string out() const { return folder_ / "out"; }
    test::Finished compare(const std::string& laws) const {
        return test::run({test::sourceDir() + "/deploy/compare-laws", scene(), "--laws", laws, "--out", out(),
                          "--bin", test::binDir()});
    }
    nlohmann::json simulated(const std::string& preset) const {
        const auto finished = test::run({"haptic_server", "simulate", "--scene", scene(), "--trajectory",
                                         out() + "/way.csv", "--set", "accuracy.preset=" + preset});
        EXPECT_EQ(finished.exit_code, 0) << finished.err;
        return nlohmann::json::parse(finished.out);
    }

    test::TemporaryFolder folder_;
};

TEST_F(CompareLaws, ALawIsMeasuredAsSimulateRunsIt) {
    const auto finished = compare("balanced,constraint,vps");
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
    const auto told = nlohmann::json::parse(test::readFile(out() + "/laws.json"));
    ASSERT_EQ(told["laws"].size(), 3u);
    EXPECT_GT(told["ticks_touching"], 300);
    EXPECT_LT(told["ticks_touching"], 500);  // the way begins in free air
    for (const auto& [index, preset] : {std::pair{0, "BALANCED"}, {1, "CONSTRAINT"}, {2, "VPS"}}) {
        const auto& law = told["laws"][static_cast<size_t>(index)];
        const auto run = simulated(preset);
        EXPECT_EQ(law["state_hash"], run["state_hash"]) << preset;
        EXPECT_EQ(law["removed_mm3"], run["removed_mm3"]) << preset;
        EXPECT_NEAR(law["force_max_n"].get<double>(), run["max_force_n"].get<double>(), 1e-6) << preset;
        EXPECT_GT(law["force_max_n"], 0) << preset;
        EXPECT_LE(law["force_p50_n"], law["force_p95_n"]) << preset;
        EXPECT_LE(law["force_p95_n"], law["force_max_n"]) << preset;
        EXPECT_GT(law["apart_max_mm"], 0) << preset;
    }
    // A rigid wall holds the burr back where the pedal is up: the hand goes on alone.
    EXPECT_GT(told["laws"][1]["apart_max_mm"], 0.2);
}

TEST_F(CompareLaws, LeavesATableAndAPicture) {
    const auto finished = compare("balanced,proxy_3dof");
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
    const std::string table = test::readFile(out() + "/laws.md");
    for (const char* part : {"force p50 N", "removed mm³", "p99 µs", "| `balanced` |", "| `proxy_3dof` |"}) {
        EXPECT_NE(table.find(part), std::string::npos) << part;
        EXPECT_NE(finished.out.find(part), std::string::npos) << part;
    }
    EXPECT_GT(std::filesystem::file_size(out() + "/laws.png"), 5000u);
}

TEST_F(CompareLaws, WhatIsWrongIsOneMessage) {
    for (const auto& [laws, part] : {std::pair{"balanced", "two to 8 different laws"},
                                     {"balanced,balanced", "two to 8 different laws"},
                                     {"balanced,foo", "takes no FOO"}}) {
        const auto finished = compare(laws);
        EXPECT_EQ(finished.exit_code, 2) << laws;
        EXPECT_TRUE(finished.err.starts_with("compare-laws: ")) << finished.err;
        EXPECT_NE(finished.err.find(part), std::string::npos) << finished.err;
    }
}

}  // namespace
}  // namespace bonemill
