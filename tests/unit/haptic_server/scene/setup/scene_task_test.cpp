// Follows the task of a scene file from real files to what judges it.
#include "haptic_server/scene/setup/scene_task.h"

#include <gtest/gtest.h>

#include <fstream>

#include "haptic_server/scene/setup/scene_setup.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/write_nrrd.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"

namespace bonemill {
namespace {

// A block of 20 x 20 x 20 voxels of 0.5 mm, all bone; W's origin is the centre of voxel 0. Label 5: x >= 15.
class SceneTask : public testing::Test {
  protected:
    SceneTask() {
        geometry_.dims.setConstant(20);
        geometry_.spacing.setConstant(0.5e-3);
        std::vector<float> values(geometry_.voxelCount(), 1000);
        std::vector<uint8_t> labels;
        forEachIndex({Eigen::Vector3i::Zero(), geometry_.dims.array() - 1},
                     [&](const Eigen::Vector3i& v) { labels.push_back(v.x() >= 15 ? 5 : 1); });
        writeNrrd(folder_ / "bone.nrrd", geometry_, values);
        writeNrrd(folder_ / "labels.nrrd", geometry_, labels);
    }
    std::shared_ptr<const JudgedTask> taskOf(const std::string& assessment) const {
        std::ofstream(folder_ / "s.textproto")
            << "volume { path: 'bone.nrrd' iso_value: 500 window_low: 0 window_high: 1000 label_path: "
               "'labels.nrrd' }\n"
               "material { name: 'rest' label: 1 } material { name: 'edge' label: 5 is_protected: true }\n"
               "assessment { "
            << assessment << " }";
        return setUpScene(loadScene(folder_ / "s.textproto")).task;
    }
    int64_t voxelsOf(const VoxelIds& map, uint8_t id) const {
        int64_t count = 0;
        forEachIndex({Eigen::Vector3i::Zero(), geometry_.dims.array() - 1},
                     [&](const Eigen::Vector3i& v) { count += map.at(v) == id; });
        return count;
    }

    test::TemporaryFolder folder_;
    VolumeGeometry geometry_;
};

// 10 x 10 x 4 voxels at the top, from x = 10 on, so that half of it is of the label.
const std::string kBox = "shape { box { center_mm { x: 7.25 y: 4.75 z: 8.75 } size_mm { x: 5 y: 5 z: 2 } } }";

TEST_F(SceneTask, AnExpertsPathIsShownButNotInAnExamination) {
    std::ofstream(folder_ / "path.csv") << "t_s,px_m,py_m,pz_m,qw,qx,qy,qz,buttons\n"
                                           "0,0,0,0,1,0,0,0,0\n2,0.004,0,0,1,0,0,0,1\n";
    const std::string scene = "zone { name: 'box' role: TARGET " + kBox + " } expert_path: 'path.csv' ";
    ASSERT_TRUE(taskOf(scene)->expert);
    EXPECT_NEAR(taskOf(scene)->expert->at(1)->position.x(), 0.002, 1e-15);
    EXPECT_FALSE(taskOf(scene + "exam: true")->expert);
    expectUserError([&] { taskOf("zone { name: 'box' role: TARGET " + kBox + " } expert_path: 'no.csv'"); },
                    {"s.textproto:3", "assessment.expert_path", "no.csv"});
}

TEST_F(SceneTask, zonesComeFromShapesAndMaterialsAndLaterOnesWin) {
    const auto task = taskOf(
        "zone { name: 'all' role: CONTAINER_SIDES material: 'rest' }"
        "zone { name: 'box' role: TARGET " +
        kBox + " } zone { name: 'both' role: PROTECTED material: 'edge' " + kBox + " }");
    ASSERT_EQ(task->zones.size(), 3u);
    EXPECT_EQ(voxelsOf(*task->map, 2), 5 * 10 * 4);
    EXPECT_EQ(voxelsOf(*task->map, 3), 5 * 10 * 4);
    EXPECT_EQ(voxelsOf(*task->map, 1), 15 * 20 * 20 - 5 * 10 * 4);
    ASSERT_EQ(task->structures.size(), 2u);
    EXPECT_EQ(task->structures[0].name, "edge");
    EXPECT_EQ(task->structures[1].name, "both");
    EXPECT_TRUE(task->isIdeal({12, 9, 18}));
    EXPECT_FALSE(task->isIdeal({16, 9, 18}));
}

TEST_F(SceneTask, aTurnedBoxIsTurned) {
    // 45 degrees about z: the corner of a square of 4 mm lies 2.83 mm from its middle.
    const auto task = taskOf(
        "zone { name: 'box' role: TARGET shape { box { center_mm { x: 5 y: 5 z: 5 } "
        "size_mm { x: 4 y: 4 z: 20 } q_WB { w: 0.9238795 z: 0.3826834 } } } }");
    EXPECT_EQ(task->map->at({10 + 5, 10, 10}), 1);  // 2.5 mm along x
    EXPECT_EQ(task->map->at({10 + 4, 10 + 4, 10}), 0);
    EXPECT_EQ(task->map->at({10 + 2, 10 + 2, 10}), 1);
}

TEST_F(SceneTask, rulesComeWithTheirLimitsAndAHashThatFollowsThem) {
    const std::string zone = "zone { name: 'box' role: TARGET " + kBox + " }";
    const std::string gate = "gate { figure: 'target.removed' at_least: 90 label: 'most of it' }";
    const auto task = taskOf(zone + gate +
                             "sub_score { figure: 'target.removed' worst: 50 best: 100 weight: 2 } "
                             "time_limit_s: 60 most_attempts: 3 feedback: LIVE approach { z: -4 }");
    ASSERT_EQ(task->gates.size(), 1u);
    EXPECT_FALSE(task->gates[0].is_most);
    EXPECT_EQ(task->gates[0].limit, 90);
    EXPECT_EQ(task->gates[0].label, "most of it");
    EXPECT_EQ(task->scores[0].weight, 2);
    EXPECT_EQ(task->feedback, TaskFeedback::kLive);
    EXPECT_EQ(*task->approach_V, -Eigen::Vector3d::UnitZ());
    EXPECT_EQ(task->weights_hash.size(), 16u);
    EXPECT_EQ(taskOf(zone + gate)->weights_hash, taskOf(gate + zone + "time_limit_s: 5")->weights_hash);
    EXPECT_NE(taskOf(zone + gate)->weights_hash, task->weights_hash);
    EXPECT_NE(taskOf(zone + gate)->weights_hash, taskOf(zone + gate + "weights_version: 2")->weights_hash);
    EXPECT_EQ(taskOf("exam: true " + zone)->feedback, TaskFeedback::kNever);
}

TEST_F(SceneTask, aReferenceIsWhatAnExpertsBoneHasLost) {
    std::vector<uint16_t> densities;
    forEachIndex({Eigen::Vector3i::Zero(), geometry_.dims.array() - 1},
                 [&](const Eigen::Vector3i& v) { densities.push_back(v.z() >= 16 ? 1000 : 65535); });
    writeNrrd(folder_ / "expert.nrrd", geometry_, densities);
    const auto task =
        taskOf("zone { name: 'box' role: TARGET " + kBox + " } reference { volume_path: 'expert.nrrd' }");
    EXPECT_EQ(voxelsOf(*task->reference, 1), 20 * 20 * 4);
    EXPECT_TRUE(task->isIdeal({0, 0, 17}));
    VolumeGeometry other = geometry_;
    other.X_WV.position.x() = 1e-3;
    writeNrrd(folder_ / "moved.nrrd", other, densities);
    expectUserError([&] { taskOf("reference { volume_path: 'moved.nrrd' }"); },
                    {"s.textproto:3", "assessment.reference.volume_path", "another grid"});
    expectUserError([&] { taskOf("reference { volume_path: 'nowhere.nrrd' }"); },
                    {"s.textproto:3", "assessment.reference.volume_path", "nowhere.nrrd"});
    expectUserError([&] { taskOf("reference { volume_path: 'labels.nrrd' }"); }, {"assessment.reference"});
}

TEST_F(SceneTask, zonesInTheWrongPlaceAreRefused) {
    expectUserError(
        [&] { taskOf("zone { name: 'far' role: TARGET shape { sphere { center_mm { x: 500 } } } }"); },
        {"s.textproto:3", "assessment.zone[0]", "\"far\" holds no bone"});
    expectUserError(
        [&] {
            taskOf("zone { name: 'a' role: TARGET " + kBox + " } zone { name: 'b' role: CONTEXT " + kBox +
                   " }");
        },
        {"assessment.zone[0]", "what zones after it take"});
    expectUserError([&] { taskOf("zone { name: 'a' role: TARGET shape { cylinder { } } }"); },
                    {"s.textproto:3", "assessment.zone[0].shape[0]", "from_mm and to_mm must differ"});
}

}  // namespace
}  // namespace bonemill
