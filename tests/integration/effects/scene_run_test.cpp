// Runs the scenes of deploy/scenes that need phantoms only, headless along their own waypoints in
// simulated time.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "common/base/units.h"
#include "haptic_server/cases/phantom/tooth_phantom.h"
#include "haptic_server/core/telemetry/fault_names.h"
#include "haptic_server/lab/simulate/run_path.h"
#include "haptic_server/recording/statistics/bone_files.h"
#include "haptic_server/scans/import/import_volume.h"
#include "haptic_server/scene/setup/scene_setup.h"
#include "tests/support/places.h"
#include "tests/support/process.h"
#include "tests/support/scene_path.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

struct ShippedRun {
    double removed_mm3 = 0, added_mm3 = 0, largest_force = 0;
    uint32_t faults = 0;
    size_t ticks_in_contact = 0;
    std::vector<std::string> effects;
    double volume_change_mm3 = 0;  // of the surface
    bool is_closed = false;
};

// Scene and phantoms lie to each other as in the repository.
class SceneRun : public testing::Test {
  protected:
    SceneRun() {
        fs::create_directory(folder_ / "deploy");
        fs::copy(test::sourceDir() + "/deploy/scenes", folder_ / "deploy/scenes");
    }
    void makePhantom(const std::string& name) const {
        const auto made = test::run({test::sourceDir() + "/deploy/make-phantoms", "--bin", test::binDir(),
                                     "--out", folder_ / "build/data", name});
        ASSERT_EQ(made.exit_code, 0) << made.err;
    }
    ShippedRun run(const std::string& name) const {
        const LoadedScene loaded = loadScene(folder_ / ("deploy/scenes/" + name + ".textproto"));
        SceneSetup simulation = setUpScene(loaded);
        for (const std::string& warning : simulation.warnings) ADD_FAILURE() << warning;
        BoneModel& bone = *simulation.bone;
        const MeshGrid grid(bone.volume, bone.lattice);
        ShippedRun result;
        result.effects = effectNames(simulation.tick.effects);
        const double before = meshVolume(meshWholeBone(bone.volume, bone.lattice), grid);
        for (const TickRecord& record :
             runPath(simulation.fixedTick(), bone,
                     test::scenePath(loaded.scene.simulated_operator(), simulation.tick.dt))) {
            result.removed_mm3 += record.removed * kPerCubicMillimetre;
            result.added_mm3 += record.added * kPerCubicMillimetre;
            result.faults |= record.faults;
            result.ticks_in_contact += record.contacts > 0;
            result.largest_force =
                std::max(result.largest_force, Eigen::Map<const Eigen::Vector3d>(record.f_hand_W).norm());
        }
        const MeshCheck check = checkMesh(meshWholeBone(bone.volume, bone.lattice), grid);
        result.is_closed = check.isClosed();
        result.volume_change_mm3 = (before - check.volume) * kPerCubicMillimetre;
        return result;
    }
    static void expectSound(const ShippedRun& run) {
        constexpr uint32_t kHarmless = kFaultMotionClamped | kFaultForceClamped;
        EXPECT_EQ(faultNames(run.faults & ~kHarmless), faultNames(0));
        EXPECT_TRUE(run.is_closed);
    }
    static void expectFelt(const ShippedRun& run) {
        EXPECT_GT(run.ticks_in_contact, 1000u);
        EXPECT_GT(run.largest_force, 0.5);
    }

    test::TemporaryFolder folder_;
};

TEST_F(SceneRun, MinimalTouchesAndDoesNothingElse) {
    makePhantom("bone_block");
    const ShippedRun run = this->run("minimal");
    expectSound(run);
    expectFelt(run);
    EXPECT_TRUE(run.effects.empty());
    EXPECT_EQ(run.removed_mm3, 0);
    EXPECT_EQ(run.volume_change_mm3, 0);
}

TEST_F(SceneRun, FreeformTakesAndGives) {
    makePhantom("clay_block");
    const ShippedRun run = this->run("freeform");
    expectSound(run);
    EXPECT_LT(run.largest_force, 0.5);  // the clay goes and comes faster than the hand, and is not in its way
    EXPECT_EQ(run.effects, (std::vector<std::string>{"time_removal", "add_material"}));
    EXPECT_GT(run.removed_mm3, 10);
    EXPECT_GT(run.added_mm3, 10);
    EXPECT_NEAR(run.volume_change_mm3, run.removed_mm3 - run.added_mm3,
                0.1 * (run.removed_mm3 + run.added_mm3));
}

TEST_F(SceneRun, LabelsOfTheToothAreItsTissues) {
    makePhantom("tooth");
    const RawVolume label = importVolume(folder_ / "build/data/tooth_labels.nrrd");
    const RawVolume scan = importVolume(folder_ / "build/data/tooth");
    EXPECT_EQ(label.geometry.dims, scan.geometry.dims);
    EXPECT_LT((label.geometry.X_WV.position - scan.geometry.X_WV.position).norm(), 1e-7);
    std::array<double, 5> sum{}, count{};
    for (size_t n = 0; n < scan.values.size(); ++n) {
        const auto tissue = size_t(label.values[n]);
        ASSERT_LT(tissue, sum.size());
        sum[tissue] += scan.values[n];
        ++count[tissue];
    }
    for (size_t tissue = 0; tissue < sum.size(); ++tissue) {
        EXPECT_GT(count[tissue], 1000) << tissue;
        EXPECT_NEAR(sum[tissue] / count[tissue], kToothHu[tissue], 250) << tissue;  // the scanner's blur
    }
}

}  // namespace
}  // namespace bonemill
