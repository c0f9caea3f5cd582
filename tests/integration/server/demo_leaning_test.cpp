// deploy/demo_leaning.py: a hand that leans feels the wall of what it mills.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

// The neck is nearly as thick as the burr, so that it touches in a shallow pit.
constexpr const char* kPitScene =
    "name: \"pit\" volume { path: \"slab.nrrd\" } effects { time_removal { rate_density_per_s: 300 } }\n"
    "tool { shape { sphere { radius_mm: 1 } } burr_radius_mm: 1\n"
    "  shape { capsule { from_mm { y: 0 } to_mm { y: 12 } radius_mm: 0.9 } } }\n";

std::string waypoint(const char* time_s, const char* z_mm, bool remove) {
    return std::string("  waypoint { time_s: ") + time_s + " p_WT_mm { z: " + z_mm +
           " } q_WT { w: 0.70710678 x: 0.70710678 }" + (remove ? " remove: true }\n" : " }\n");
}

class DemoLeaning : public testing::Test {
  protected:
    DemoLeaning() {
        EXPECT_EQ(
            test::run({"make_phantom", "body", "--kind", "slab", "--out", folder_ / "slab.nrrd"}).exit_code,
            0);
    }
    std::string out() const { return folder_ / "out"; }
    test::Finished lean(bool mills) const {
        test::writeFile(folder_ / "pit.textproto",
                        std::string(kPitScene) + "simulated_operator {\n" + waypoint("0", "3.1", mills) +
                            waypoint("1", "1.5", mills) + waypoint("2.5", "-0.8", mills) +
                            waypoint("3", "3.1", false) + "}\n");
        return test::run({test::sourceDir() + "/deploy/demo_leaning.py", folder_ / "pit.textproto",
                          "--server", test::binDir() + "/haptic_server", "--out", out()});
    }

    test::TemporaryFolder folder_;
};

TEST_F(DemoLeaning, TheShaftTouchesTheWall) {
    const auto finished = lean(true);
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
    const auto told = nlohmann::json::parse(test::readFile(out() + "/logs/leaning.json"));
    EXPECT_GT(told["removed_mm3"], 1);
    EXPECT_GT(told["max_torque_nm"], 5e-4);
    EXPECT_EQ(told["fault_names"], "none");
    for (const char* picture : {"/plot_leaning.png", "/orientation_leaning.png"})
        EXPECT_GT(std::filesystem::file_size(out() + picture), 5000u) << picture;
}

TEST_F(DemoLeaning, AHandThatMillsNothingIsRefused) {
    const auto finished = lean(false);
    EXPECT_EQ(finished.exit_code, 2);
    EXPECT_NE(finished.err.find("mills nothing"), std::string::npos) << finished.err;
}

}  // namespace
}  // namespace bonemill
