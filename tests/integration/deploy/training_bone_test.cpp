// deploy/make-training-bone: bones of either side and any difficulty, and hands that spare what is in them.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "common/base/units.h"
#include "common/config/scene_file.h"
#include "haptic_server/core/volume/index_box.h"
#include "haptic_server/scans/import/import_volume.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

struct Case {
    std::string seed, side, difficulty;
    std::string kind = "temporal_bone", prefix = "bone";
};

class MakeTrainingBone : public testing::Test {
  protected:
    test::Finished make(const Case& made) const {
        return test::run({test::sourceDir() + "/deploy/make-training-bone", made.kind, "--bin",
                          test::binDir(), "--out", folder_.path(), "--voxel-mm", "0.5", "--seed", made.seed,
                          "--side", made.side, "--difficulty", made.difficulty});
    }
    std::string nameOf(const Case& made) const {
        return made.prefix + "_" + made.seed + "_" + made.side + "_" + made.difficulty;
    }

    test::TemporaryFolder folder_;
};

Vector3d placeOf(const scene::SimulatedOperator::Waypoint& waypoint) {
    return {waypoint.p_wt_mm().x(), waypoint.p_wt_mm().y(), waypoint.p_wt_mm().z()};
}

// Middles of the voxels of these structures, of all without any, mm in W.
std::vector<Vector3d> structuresOf(const std::string& labels_file, const std::set<int>& wanted = {}) {
    const RawVolume labels = importVolume(labels_file);
    std::vector<Vector3d> all;
    forEachIndex({Eigen::Vector3i::Zero(), labels.geometry.dims.array() - 1}, [&](const Eigen::Vector3i& v) {
        const int label = int(labels.values[placeIn(labels.geometry.dims, v)]);
        if (label == 0 || (!wanted.empty() && !wanted.contains(label))) return;
        const Vector3d p = labels.geometry.X_WV * labels.geometry.spacing.cwiseProduct(v.cast<double>());
        all.push_back(p * kPerMillimetre);
    });
    return all;
}

// Of the burr's surface, with the pedal down, to the nearest structure.
double nearest_mm(const scene::SimulatedOperator& hand, double burr_mm,
                  const std::vector<Vector3d>& structures) {
    double nearest = std::numeric_limits<double>::infinity();
    for (int n = 0; n + 1 < hand.waypoint_size(); ++n) {
        if (!hand.waypoint(n).remove()) continue;
        const Vector3d from = placeOf(hand.waypoint(n)), to = placeOf(hand.waypoint(n + 1));
        for (const double share : {0.0, 0.5})
            for (const Vector3d& p : structures)
                nearest = std::min(nearest, (from + share * (to - from) - p).norm() - burr_mm);
    }
    return nearest;
}

TEST_F(MakeTrainingBone, PlansAHandForEachBone) {
    for (const Case& each : {Case{"6", "left", "middle"}, {"7", "right", "hard"}}) {
        SCOPED_TRACE(nameOf(each));
        const test::Finished made = make(each);
        ASSERT_EQ(made.exit_code, 0) << made.err;
        const std::string file = folder_ / (nameOf(each) + ".textproto");
        EXPECT_EQ(made.out, file + "\n");
        const scene::Scene scene = loadScene(file).scene;
        EXPECT_EQ(scene.name(), nameOf(each));
        EXPECT_NE(scene.title().find("phantom"), std::string::npos);
        const scene::SimulatedOperator& hand = scene.simulated_operator();
        EXPECT_GT(nearest_mm(hand, 3, structuresOf(folder_ / (nameOf(each) + "_labels.nrrd"))), 0.8);
        // The antrum lies 14 mm below the surface; the hand ends where a burr of 3 mm has opened it.
        const Vector3d last = placeOf(hand.waypoint(hand.waypoint_size() - 4));
        EXPECT_LT((last - Vector3d(each.side == "right" ? 13.9 : -13.9, 5.2, 0)).norm(), 7);
    }
    const test::Finished listed = test::run({"haptic_server", "--scenes", folder_.path(), "--list-scenes"});
    EXPECT_EQ(listed.exit_code, 0) << listed.out << listed.err;
}

TEST_F(MakeTrainingBone, ARightEarsSceneIsTheMirrorImage) {
    const Case left{"5", "left", "easy"}, right{"5", "right", "easy"};
    ASSERT_EQ(make(left).exit_code, 0);
    ASSERT_EQ(make(right).exit_code, 0);
    const scene::Scene l = loadScene(folder_ / (nameOf(left) + ".textproto")).scene;
    const scene::Scene r = loadScene(folder_ / (nameOf(right) + ".textproto")).scene;
    EXPECT_EQ(r.camera().azimuth_deg(), -l.camera().azimuth_deg());
    EXPECT_EQ(r.device().p_wd_mm().x(), -l.device().p_wd_mm().x());
    EXPECT_EQ(r.device().q_wd().z(), -l.device().q_wd().z());
    EXPECT_EQ(r.assessment().approach().x(), -l.assessment().approach().x());
    for (int n = 0; n < l.assessment().zone_size(); ++n)
        for (int s = 0; s < l.assessment().zone(n).shape_size(); ++s) {
            const auto &of_left = l.assessment().zone(n).shape(s),
                       &of_right = r.assessment().zone(n).shape(s);
            EXPECT_EQ(of_right.cylinder().from_mm().x(), -of_left.cylinder().from_mm().x());
            EXPECT_EQ(of_right.cylinder().to_mm().x(), -of_left.cylinder().to_mm().x());
            EXPECT_EQ(of_right.box().center_mm().x(), -of_left.box().center_mm().x());
            EXPECT_EQ(of_right.box().size_mm().x(), of_left.box().size_mm().x());
        }
    EXPECT_EQ(r.simulated_operator().waypoint(5).q_wt().z(), -l.simulated_operator().waypoint(5).q_wt().z());
}

TEST_F(MakeTrainingBone, PlansAHandForEachThirdMolar) {
    for (const Case& each : {Case{"2", "left", "easy", "third_molar", "molar"},
                             Case{"3", "right", "hard", "third_molar", "molar"}}) {
        SCOPED_TRACE(nameOf(each));
        const test::Finished made = make(each);
        ASSERT_EQ(made.exit_code, 0) << made.err;
        const scene::Scene scene = loadScene(folder_ / (nameOf(each) + ".textproto")).scene;
        EXPECT_EQ(scene.name(), nameOf(each));
        const scene::SimulatedOperator& hand = scene.simulated_operator();
        EXPECT_GT(hand.waypoint_size(), 30);
        const std::string labels = folder_ / (nameOf(each) + "_labels.nrrd");
        EXPECT_GT(nearest_mm(hand, 1.5, structuresOf(labels, {1})), 1) << "nerve";
        EXPECT_GT(nearest_mm(hand, 1.5, structuresOf(labels, {5, 6})), 0.1) << "second molar, lingual plate";
        EXPECT_GT(nearest_mm(hand, 1.5, structuresOf(labels, {2, 3, 4})), -0.5) << "crown";
    }
}

// The labels of the vertebra: 1 shell, 2 core, 3 dural sac, 4 left root, 5 right root, 6 vessel.
TEST_F(MakeTrainingBone, APedicleIsNarrowerAndUnguardedWhereItIsHarder) {
    double bone_beside = std::numeric_limits<double>::infinity();
    for (const Case& each :
         {Case{"2", "left", "easy", "pedicle", "pedicle"}, Case{"3", "left", "middle", "pedicle", "pedicle"},
          Case{"4", "right", "hard", "pedicle", "pedicle"}}) {
        SCOPED_TRACE(nameOf(each));
        const test::Finished made = make(each);
        ASSERT_EQ(made.exit_code, 0) << made.err;
        const scene::Scene scene = loadScene(folder_ / (nameOf(each) + ".textproto")).scene;
        EXPECT_EQ(scene.effects().has_virtual_fixture(), each.difficulty == "easy");
        const std::string root = each.side + " nerve root";
        EXPECT_TRUE(std::ranges::any_of(scene.assessment().gate(), [&](const auto& gate) {
            return gate.figure() == "structure.lost_volume:" + root;
        }));
        const std::string labels = folder_ / (nameOf(each) + "_labels.nrrd");
        const scene::SimulatedOperator& hand = scene.simulated_operator();
        EXPECT_GT(nearest_mm(hand, 2, structuresOf(labels, {3, 4, 5, 6})), 1);
        // How much bone is beside the corridor, where the pedicle is narrowest.
        const double side = each.side == "left" ? 1 : -1;
        double bone = 0;
        for (const Vector3d& p : structuresOf(labels, {1, 2}))
            bone += std::abs(p.y() - 20) < 0.3 && std::abs(p.z() - 4.5) < 0.3 && side * p.x() > 8;
        EXPECT_LT(bone, 0.85 * bone_beside);
        bone_beside = bone;
    }
}

TEST_F(MakeTrainingBone, SaysWhatIsWrong) {
    const test::Finished refused = make({"-3", "left", "easy"});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find("--seed"), std::string::npos) << refused.err;
    EXPECT_EQ(refused.err.find("Traceback"), std::string::npos);
}

}  // namespace
}  // namespace bonemill
