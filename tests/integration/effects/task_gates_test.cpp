// Who does the tasks of the shipped scenes well passes, and who does not fails by the name of the gate: the
// scene's own hand, and hands that go astray.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/base/units.h"
#include "haptic_server/lab/simulate/run_path.h"
#include "haptic_server/lab/simulate/task_run.h"
#include "tests/support/places.h"
#include "tests/support/process.h"
#include "tests/support/scene_path.h"
#include "tests/support/write_nrrd.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

class TaskGates : public testing::Test {
  protected:
    // Scene and phantoms lie to each other as in the repository.
    TaskGates() {
        fs::create_directory(folder_.path() / "deploy");
        fs::copy(test::sourceDir() + "/deploy/scenes", folder_.path() / "deploy/scenes");
    }
    void makePhantom(const std::string& name) const {
        const auto made = test::run({test::sourceDir() + "/deploy/make-phantoms", "--bin", test::binDir(),
                                     "--out", folder_ / "build/data", name});
        ASSERT_EQ(made.exit_code, 0) << made.err;
    }
    std::string shipped(const std::string& name) const {
        return folder_ / ("deploy/scenes/" + name + ".textproto");
    }
    std::string trainingPedicle(const std::string& seed, const std::string& side,
                                const std::string& difficulty) const {
        const auto made = test::run({test::sourceDir() + "/deploy/make-training-bone", "pedicle", "--bin",
                                     test::binDir(), "--out", folder_ / "bones", "--seed", seed, "--side",
                                     side, "--difficulty", difficulty});
        EXPECT_EQ(made.exit_code, 0) << made.err;
        return made.out.substr(0, made.out.find('\n'));
    }
    struct Attempt {
        Assessment assessment;
        std::vector<double> forces;  // on the hand in ticks that remove bone, N, the lowest first
    };
    // `astray`: what is added to the hand's way while the pedal is down or the burr is in the bone, mm in W.
    Assessment attempt(const std::string& name,
                       const Eigen::Vector3d& astray_mm = Eigen::Vector3d::Zero()) const {
        return attemptAt(shipped(name), astray_mm).assessment;
    }
    static Attempt attemptAt(const std::string& scene_file,
                             const Eigen::Vector3d& astray_mm = Eigen::Vector3d::Zero()) {
        const LoadedScene loaded = loadScene(scene_file);
        SceneSetup simulation = setUpScene(loaded);
        const VoxelVolume scanned = simulation.bone->volume.withoutSpareBricks();
        TaskRun task(loaded.scene, simulation);
        std::vector<DeviceInput> path =
            test::scenePath(loaded.scene.simulated_operator(), simulation.tick.dt);
        for (DeviceInput& input : path) input.X_WT_device.position += astray_mm * kMillimetre;
        Attempt attempt;
        for (const TickRecord& record : runPath(simulation.fixedTick(), *simulation.bone, path)) {
            task.add(record);
            if (record.removed > 0) attempt.forces.push_back(Eigen::Vector3d(record.f_hand_W).norm());
        }
        std::ranges::sort(attempt.forces);
        attempt.assessment = task.judgeBone(scanned, simulation.bone->volume).assessment;
        return attempt;
    }
    static std::vector<std::string> broken(const Assessment& assessment) {
        std::vector<std::string> all;
        for (const GateResult& gate : assessment.gates)
            if (!gate.is_passed) all.push_back(gate.figure_id);
        return all;
    }
    static void expectPassed(const Assessment& assessment) {
        EXPECT_GE(assessment.gates.size(), 3u);
        for (const GateResult& gate : assessment.gates) EXPECT_TRUE(gate.is_passed) << gate.text;
        ASSERT_TRUE(assessment.total);
        EXPECT_GT(assessment.total->score, 0.3);
    }

    // With half a newton to two.
    static void expectPressedAsByAPerson(const Attempt& attempt) {
        expectPassed(attempt.assessment);
        ASSERT_GT(attempt.forces.size(), 3000u);
        EXPECT_GE(attempt.forces[attempt.forces.size() / 20], 0.5);
        EXPECT_LE(attempt.forces[attempt.forces.size() * 19 / 20], 2);
    }

    test::TemporaryFolder folder_;
};

TEST_F(TaskGates, TheHandsOfTheToothScenesPass) {
    makePhantom("tooth");
    for (const char* name : {"tooth_corridor", "tooth_cavity", "tooth_caries"}) {
        SCOPED_TRACE(name);
        expectPassed(attempt(name));
    }
}

TEST_F(TaskGates, WhoDrillsIntoThePulpFailsByIt) {
    makePhantom("tooth");
    const Assessment deep = attempt("tooth_caries", {0, 0, -1.8});
    EXPECT_FALSE(deep.hasPassed());
    const auto names = broken(deep);
    EXPECT_NE(std::ranges::find(names, "structure.lost_volume:pulp"), names.end());
}

TEST_F(TaskGates, ThePediclesHandPassesAndOneThatBreaksIntoTheCanalFailsByTheBreach) {
    makePhantom("vertebra");
    expectPressedAsByAPerson(attemptAt(shipped("pedicle")));
    const Assessment medial = attempt("pedicle", {-5.5, 0, 0});
    EXPECT_FALSE(medial.hasPassed());
    const auto names = broken(medial);
    EXPECT_NE(std::ranges::find(names, "breach.grade"), names.end());
    EXPECT_GE(findFigure(medial.figures, "breach.depth")->value, 2);
}

TEST_F(TaskGates, TheHandsOfAllKindsOfTrainingPediclesPressWithHalfANewtonToTwo) {
    for (const std::string& scene :
         {trainingPedicle("1", "left", "easy"), trainingPedicle("3", "right", "middle"),
          trainingPedicle("4", "left", "hard")}) {
        SCOPED_TRACE(scene);
        expectPressedAsByAPerson(attemptAt(scene));
    }
}

TEST_F(TaskGates, TheThirdMolarsHandPassesAndOneThatStraysToTheTongueFailsByThePlate) {
    makePhantom("third_molar");
    expectPassed(attempt("third_molar"));
    const Assessment lingual = attempt("third_molar", {-4, 0, -2});
    EXPECT_FALSE(lingual.hasPassed());
    const auto names = broken(lingual);
    EXPECT_NE(std::ranges::find(names, "structure.lost_volume:lingual plate"), names.end());
}

// A nerve of soft tissue in soft tissue, 13 mm below all bone, in a region with fine voxels.
void writeNerveScene(const test::TemporaryFolder& folder) {
    VolumeGeometry scan;
    scan.dims = {24, 24, 30};
    scan.spacing.setConstant(1e-3);
    std::vector<float> values;
    std::vector<uint8_t> labels;
    forEachIndex({Eigen::Vector3i::Zero(), scan.dims.array() - 1}, [&](const Eigen::Vector3i& v) {
        values.push_back(v.z() >= 22 ? 1500.0f : 40.0f);
        labels.push_back((v - Eigen::Vector3i(12, 12, 6)).cast<double>().norm() < 3 ? 1 : 0);
    });
    writeNrrd(folder / "scan.nrrd", scan, values);
    writeNrrd(folder / "labels.nrrd", scan, labels);
    std::ofstream(folder / "nerve.textproto")
        << "volume { path: 'scan.nrrd' label_path: 'labels.nrrd' iso_value: 500 window_low: -1000\n"
           "  region { min_mm { x: 4 y: 4 z: 1 } max_mm { x: 20 y: 20 z: 26 } resample_mm: 0.25 } }\n"
           "tool { burr_radius_mm: 1 }\n"
           "material { name: 'nerve' label: 1 is_protected: true }\n"
           "effects { time_removal {} }\n"
           "assessment { gate { figure: 'structure.lost_volume:nerve' at_most: 0 } }\n";
}

TEST(SoftNerveFarFromBone, IsLostWhereTheBurrGoesThroughIt) {
    const test::TemporaryFolder folder;
    writeNerveScene(folder);
    const LoadedScene loaded = loadScene(folder / "nerve.textproto");
    SceneSetup simulation = setUpScene(loaded);
    const VoxelVolume scanned = simulation.bone->volume.withoutSpareBricks();
    TaskRun task(loaded.scene, simulation);
    std::vector<Pose> path;
    for (int n = 0; n <= 2000; ++n) path.emplace_back().position = {12e-3, 12e-3, 12e-3 - 12e-3 * n / 2000};
    for (const TickRecord& record :
         runPath(simulation.fixedTick(), *simulation.bone, inputsOf(path, simulation.tick.dt, kButtonRemove)))
        task.add(record);
    const Assessment judged = task.judgeBone(scanned, simulation.bone->volume).assessment;
    // A canal as thick as the burr, through a ball of 6 mm, would be 18 mm³; its rim keeps more than half.
    const double lost = findFigure(judged.figures, "structure.lost_volume:nerve")->value;
    EXPECT_GT(lost, 6);
    EXPECT_LT(lost, 20);
    EXPECT_FALSE(judged.hasPassed());
}

}  // namespace
}  // namespace bonemill
