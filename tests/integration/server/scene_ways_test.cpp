// Every scene of deploy/scenes loads, is described and runs: its own way in fast motion, on phantoms made for
// this test.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/config/scene_file.h"
#include "device_daemon/ares/emulator/scenario.h"
#include "device_daemon/device_setup/device_setup.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

constexpr int kTicks = 600;
const fs::path kScenes = fs::path(test::sourceDir()) / "deploy/scenes";

std::vector<std::string> shippedScenes() {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(kScenes))
        if (entry.path().extension() == ".textproto") names.push_back(entry.path().stem());
    std::sort(names.begin(), names.end());
    return names;
}

// The scenes are copies, so that the phantoms that their relative paths name are those of this test.
class SceneWays : public testing::Test {
  protected:
    SceneWays() {
        fs::create_directories(folder_.path() / "deploy");
        fs::create_directories(folder_.path() / "build/data");
        fs::copy(kScenes, folder_.path() / "deploy/scenes");
        makeCoarseTemporalBone();
        const auto made = test::run({test::sourceDir() + "/deploy/make-phantoms", "--bin", test::binDir(),
                                     "--out", folder_ / "build/data"});
        EXPECT_EQ(made.exit_code, 0) << made.err;
    }
    std::string fileOf(const std::string& name) const {
        return folder_ / ("deploy/scenes/" + name + ".textproto");
    }
    // deploy/make-phantoms leaves alone what is there already; its voxels would take ten times as long.
    void makeCoarseTemporalBone() const {
        const std::string bone = folder_ / "build/data/temporal_bone";
        const auto made = test::run({"make_phantom", "temporal_bone", "--voxel-mm", "0.5", "--out",
                                     bone + ".nrrd", "--labels", bone + "_labels.nrrd"});
        EXPECT_EQ(made.exit_code, 0) << made.err;
        std::ofstream(bone + ".made");
    }
    void expectRuns(const LoadedScene& loaded);

    test::TemporaryFolder folder_;
};

// Writes the hand's way, so fast that it is done after kTicks.
void writeTrajectory(const Scenario& scenario, const Pose& X_WD, const std::string& file) {
    std::ofstream out(file);
    out.precision(17);
    out << "t_s,px_m,py_m,pz_m,qw,qx,qy,qz,buttons\n";
    for (int n = 0; n < kTicks; ++n) {
        const HandTarget target = scenario.path.at(scenario.path.duration() * n / kTicks);
        const Pose X_WT = X_WD * target.X_DT;
        const Eigen::Vector3d& p = X_WT.position;
        const Eigen::Quaterniond& q = X_WT.rotation;
        out << n / scenario.rate_hz << ',' << p.x() << ',' << p.y() << ',' << p.z() << ',' << q.w() << ','
            << q.x() << ',' << q.y() << ',' << q.z() << ',' << target.buttons << '\n';
    }
}

bool hasData(const LoadedScene& loaded) {
    const scene::Volume& volume = loaded.scene.volume();
    return fs::exists(resolvePath(loaded, volume.path())) &&
           (volume.label_path().empty() || fs::exists(resolvePath(loaded, volume.label_path())));
}

void expectWellFormed(const scene::Scene& scene, const std::string& name) {
    EXPECT_EQ(scene.name(), name);
    EXPECT_GT(scene.tool_size(), 0);
    EXPECT_TRUE(scene.has_camera());
    const auto& waypoints = scene.simulated_operator().waypoint();
    ASSERT_GE(waypoints.size(), 3);
    EXPECT_FALSE(waypoints[0].remove() || waypoints[0].add());
    EXPECT_FALSE(waypoints[waypoints.size() - 1].remove() || waypoints[waypoints.size() - 1].add());
}

void SceneWays::expectRuns(const LoadedScene& loaded) {
    const Scenario scenario = scenarioOf(loaded.scene);  // throws if the device cannot go that way
    EXPECT_GE(scenario.path.duration(), 5);
    EXPECT_LE(scenario.path.duration(), 120);
    const std::string trajectory = folder_ / "way.csv";
    writeTrajectory(scenario, deviceSetupOf(loaded.scene).X_WD, trajectory);
    const auto run =
        test::run({"haptic_server", "simulate", "--scene", loaded.file, "--trajectory", trajectory});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto result = nlohmann::json::parse(run.out.substr(run.out.rfind('\n', run.out.size() - 2) + 1));
    EXPECT_EQ(result["ticks"].get<double>(), kTicks);
    EXPECT_GT(result["max_contacts"].get<double>(), 0) << "the tool never meets the bone";
    EXPECT_TRUE(result["mesh"]["is_closed"]);
    const auto& waypoints = loaded.scene.simulated_operator().waypoint();
    const auto any = [&](auto&& wants) { return std::any_of(waypoints.begin(), waypoints.end(), wants); };
    if (any([](const auto& w) { return w.remove() && !w.add(); })) {
        EXPECT_GT(result["removed_mm3"].get<double>(), 0);
    }
}

TEST_F(SceneWays, LoadAndRunTheirOwnWay) {
    int run = 0;
    for (const std::string& name : shippedScenes()) {
        SCOPED_TRACE(name);
        const LoadedScene loaded = loadScene(fileOf(name));
        expectWellFormed(loaded.scene, name);
        if (!hasData(loaded))
            continue;  // a scan that is not on this machine, or what another run leaves behind
        expectRuns(loaded);
        ++run;
    }
    EXPECT_GE(run, 6) << "the phantoms' scenes run everywhere";
}

}  // namespace
}  // namespace bonemill
