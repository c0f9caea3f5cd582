// libbonemill, through its header: the tick of `haptic_server simulate`.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "common/text/hex_text.h"
#include "haptic_server/apps/library/bonemill/simulation.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

constexpr const char* kScene =
    "name: \"block\" volume { path: \"block.nrrd\" } effects { time_removal {} }\n"
    "tool { name: \"2 mm\" shape { sphere { radius_mm: 1 } } burr_radius_mm: 1 }\n"
    "tool { name: \"4 mm\" shape { sphere { radius_mm: 2 } } burr_radius_mm: 2 }\n"
    "assessment { zone { name: \"cavity\" role: TARGET shape { cylinder { from_mm { z: -0.75 } to_mm { z: "
    "1.25 } "
    "radius_mm: 1 } } } }\n";
constexpr int kTicks = 300;

class Library : public testing::Test {
  protected:
    Library() {
        const auto made =
            test::run({"make_phantom", "body", "--kind", "slab", "--voxel-mm", "0.125", "--dims", "40", "40",
                       "40", "--thickness-mm", "2.5", "--out", folder_ / "block.nrrd"});
        EXPECT_EQ(made.exit_code, 0) << made.err;
        test::writeFile(scene(), kScene);
    }
    std::string scene() const { return folder_ / "block.textproto"; }
    static Hand handAt(int tick) {
        Hand hand;
        hand.position_W = {0, 0, 3e-3 - 1.4e-3 * tick / kTicks};
        hand.buttons = kRemove;
        return hand;
    }
    static double run(Simulation& simulation, int from, int to) {
        double removed = 0;
        for (int tick = from; tick < to; ++tick) removed += simulation.step(handAt(tick)).removed;
        return removed;
    }

    test::TemporaryFolder folder_;
};

TEST_F(Library, StepsAsSimulateDoes) {
    Simulation simulation(scene());
    std::ostringstream trajectory;
    trajectory.precision(17);
    trajectory << "t_s,px_m,py_m,pz_m,qw,qx,qy,qz,buttons\n";
    for (int tick = 0; tick < kTicks; ++tick)
        trajectory << tick * simulation.period() << ",0,0," << handAt(tick).position_W[2] << ",1,0,0,0,1\n";
    test::writeFile(folder_ / "way.csv", trajectory.str());
    const double removed = run(simulation, 0, kTicks);
    const auto simulated =
        test::run({"haptic_server", "simulate", "--scene", scene(), "--trajectory", folder_ / "way.csv"});
    ASSERT_EQ(simulated.exit_code, 0) << simulated.err;
    const auto json = nlohmann::json::parse(simulated.out);
    EXPECT_EQ(hexText(simulation.stateHash()), json["state_hash"]);
    EXPECT_NEAR(removed * 1e9, json["removed_mm3"].get<double>(), 1e-9);
    EXPECT_GT(removed * 1e9, 0.5);
    EXPECT_EQ(nlohmann::json::parse(simulation.judge()), json["assessment"]);
}

TEST_F(Library, ComesBackToACheckpoint) {
    Simulation simulation(scene());
    run(simulation, 0, 200);
    const Checkpoint checkpoint = simulation.checkpoint();
    const uint64_t then = simulation.stateHash();
    EXPECT_EQ(checkpoint.ticks(), 200u);
    simulation.chooseTool("4 mm");
    const double larger = run(simulation, 200, kTicks);
    simulation.judge();
    simulation.restore(checkpoint);
    EXPECT_EQ(simulation.stateHash(), then);
    EXPECT_LT(run(simulation, 200, kTicks), larger) << "it is the smaller burr again";
    simulation.reset();
    EXPECT_EQ(simulation.ticks(), 0u);
    Simulation moved = std::move(simulation);
    moved.restore(checkpoint);
    EXPECT_EQ(moved.stateHash(), then);
}

TEST_F(Library, ShowsItsBone) {
    Simulation simulation(scene());
    const auto boneVoxels = [&simulation] {
        const Voxels voxels = simulation.voxels();
        EXPECT_EQ(voxels.dims, (std::array<int, 3>{40, 40, 40}));
        return std::count_if(voxels.densities.begin(), voxels.densities.end(),
                             [&](uint16_t density) { return density >= voxels.iso_density; });
    };
    const auto before = boneVoxels();
    const double removed = run(simulation, 0, kTicks);
    const double voxel = std::pow(0.125e-3, 3);
    EXPECT_NEAR(double(before - boneVoxels()) * voxel, removed, 1e-15);
    const Mesh mesh = simulation.mesh();
    double volume = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vector3 &p = mesh.vertices_W[a], &q = mesh.vertices_W[b], &r = mesh.vertices_W[c];
        volume += (p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) +
                   p[2] * (q[0] * r[1] - q[1] * r[0])) /
                  6;
    }
    EXPECT_NEAR(volume / (double(boneVoxels()) * voxel), 1, 0.06);
}

TEST_F(Library, TellsWhatItsEffectsDo) {
    SimulationOptions options;
    options.settings = {"effects.spindle={}", "tool[0].speed_rpm=10000", "tool[1].speed_rpm=10000"};
    Simulation simulation(scene(), options);
    run(simulation, 0, kTicks);
    std::set<std::string> names;
    for (const auto& [name, value] : simulation.figures()) names.insert(name);
    EXPECT_TRUE(names.contains("spin_rpm"));
    EXPECT_EQ(Simulation::faultNames(4), std::vector<std::string>{"bad_device_pose"});
}

TEST_F(Library, RefusesWithOneLine) {
    const auto refusal = [](auto&& call) -> std::string {
        try {
            call();
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    Simulation simulation(scene());
    Hand nowhere;
    nowhere.position_W[1] = NAN;
    EXPECT_NE(refusal([&] { simulation.step(nowhere); }).find("not finite"), std::string::npos);
    EXPECT_NE(refusal([&] { simulation.chooseTool("saw"); }).find("no tool"), std::string::npos);
    EXPECT_NE(refusal([&] { Simulation(folder_ / "no.textproto"); }).find("no.textproto"), std::string::npos);
    SimulationOptions other;
    other.settings = {"contact.stiffness_n_per_mm3=500"};
    Simulation softer(scene(), other);
    EXPECT_NE(refusal([&] { softer.restore(simulation.checkpoint()); }).find("another scene"),
              std::string::npos);
    EXPECT_EQ(simulation.ticks(), 0u);
}

}  // namespace
}  // namespace bonemill
