// What becomes of a scan by what the scene says of its volume: pieces and the region.
#include "haptic_server/scene/setup/scanned_bone.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "haptic_server/scene/setup/scene_setup.h"
#include "haptic_server/surface/mesh/structure_mesher.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/write_nrrd.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"

namespace bonemill {
namespace {

constexpr double kMm = 1e-3;

// Two balls of bone in air on voxels of 1 x 1 x 1.5 mm, and a speck: pieces 1, 2 and 3.
class ScannedBoneOfAScene : public testing::Test {
  protected:
    ScannedBoneOfAScene() {
        geometry_.dims = {40, 30, 20};
        geometry_.spacing = Eigen::Vector3d(1, 1, 1.5) * kMm;
        std::vector<float> values;
        forEachIndex({Eigen::Vector3i::Zero(), geometry_.dims.array() - 1}, [&](const Eigen::Vector3i& v) {
            const Eigen::Vector3d p = geometry_.spacing.cwiseProduct(v.cast<double>());
            const double d = std::min((p - large_).norm() - 8 * kMm, (p - small_).norm() - 4 * kMm);
            values.push_back(v == Eigen::Vector3i(37, 3, 2)
                                 ? 1000.0f
                                 : float(std::clamp(500 - 500 * d / kMm, -1000.0, 1500.0)));
        });
        writeNrrd(folder_ / "scan.nrrd", geometry_, values);
    }
    LoadedScene sceneOf(const std::string& of_volume, const std::string& more = "") const {
        std::ofstream(folder_ / "s.textproto")
            << "volume { path: 'scan.nrrd' iso_value: 500 window_low: -1000 window_high: 2000\n"
            << of_volume << "}\n"
            << more;
        return loadScene(folder_ / "s.textproto");
    }
    ScannedBone boneOf(const std::string& of_volume, const std::string& more = "") const {
        return readBone(sceneOf(of_volume, more));
    }
    static bool says(const ScannedBone& bone, const std::string& word) {
        return std::ranges::any_of(
            bone.remarks, [&](const std::string& remark) { return remark.find(word) != std::string::npos; });
    }
    static bool isBoneAt(const VoxelVolume& volume, const Eigen::Vector3d& p_W) {
        const Eigen::Vector3i v = (volume.geometry().X_WV.inverse() * p_W)
                                      .cwiseQuotient(volume.spacing())
                                      .array()
                                      .round()
                                      .cast<int>();
        return volume.at(v.x(), v.y(), v.z()) >= volume.iso();
    }

    const Eigen::Vector3d large_ = Eigen::Vector3d(12, 15, 15) * kMm,
                          small_ = Eigen::Vector3d(28, 15, 15) * kMm;
    test::TemporaryFolder folder_;
    VolumeGeometry geometry_;
};

TEST_F(ScannedBoneOfAScene, HasAllPiecesIfItDoesNotChoose) {
    const ScannedBone bone = boneOf("");
    EXPECT_TRUE(isBoneAt(bone.volume, large_));
    EXPECT_TRUE(isBoneAt(bone.volume, small_));
    EXPECT_TRUE(isBoneAt(bone.volume, Eigen::Vector3d(37, 3, 3) * kMm));
    EXPECT_FALSE(bone.surroundings);
}

// Half a scan voxel under the surface the value is 750 and more; on the surface it is 500.
TEST_F(ScannedBoneOfAScene, FineVoxelsAreAsHardAtTheSurfaceAsTheScansOwn) {
    const std::string region =
        "region { min_mm { x: 2 y: 5 z: 5 } max_mm { x: 22 y: 25 z: 25 } resample_mm: 0.25 }";
    const std::string hard = "material { name: 'hard' from_value: 650 }";
    const ScannedBone bone = boneOf(region, hard);
    size_t voxels = 0, soft = 0;
    forEachIndex({Eigen::Vector3i::Zero(), bone.volume.dims().array() - 1}, [&](const Eigen::Vector3i& v) {
        const size_t at = voxels++;
        if (bone.volume.at(v.x(), v.y(), v.z()) >= bone.volume.iso())
            soft += bone.materials.ids[at] == kNoMaterial;
    });
    EXPECT_EQ(soft, 0u);
    const SceneSetup simulation = setUpScene(sceneOf(region, hard));
    const BoneProperties& properties = *simulation.tick.effects.properties;
    Density softest = kMaxDensity;
    forEachIndex({Eigen::Vector3i::Zero(), bone.volume.dims().array() - 1}, [&](const Eigen::Vector3i& v) {
        if (bone.volume.at(v.x(), v.y(), v.z()) >= bone.volume.iso())
            softest = std::min(softest, properties.original(v));
    });
    EXPECT_GE(softest, bone.mapping.density(650));
}

TEST_F(ScannedBoneOfAScene, KeepsTheLargestPieceAndSaysWhatWent) {
    const ScannedBone bone = boneOf("keep_pieces: LARGEST_PIECE");
    EXPECT_TRUE(isBoneAt(bone.volume, large_));
    EXPECT_FALSE(isBoneAt(bone.volume, small_));
    EXPECT_FALSE(isBoneAt(bone.volume, Eigen::Vector3d(37, 3, 3) * kMm));
    EXPECT_TRUE(says(bone, "kept piece 1"));
    EXPECT_TRUE(says(bone, "around (12.0, 15.0, 15.0) mm"));
    EXPECT_TRUE(says(bone, "dropped piece 2"));
    EXPECT_TRUE(says(bone, "piece 3: 1 voxels"));
}

TEST_F(ScannedBoneOfAScene, DropsPiecesByNumber) {
    const ScannedBone bone = boneOf("drop_piece: 1 drop_piece: 3");
    EXPECT_FALSE(isBoneAt(bone.volume, large_));
    EXPECT_TRUE(isBoneAt(bone.volume, small_));
    EXPECT_FALSE(isBoneAt(bone.volume, Eigen::Vector3d(37, 3, 3) * kMm));
}

TEST_F(ScannedBoneOfAScene, RefusesPiecesThatAreNotThere) {
    expectUserError([&] { boneOf("drop_piece: 4"); },
                    {"s.textproto:2", "volume.drop_piece[0]", "only 3 pieces"});
    expectUserError([&] { boneOf("drop_piece: [1, 2, 3]"); }, {"all pieces", "piece 1:"});
    expectUserError([&] { boneOf("keep_pieces: TOUCHING_REGION"); }, {"volume.keep_pieces", "volume.region"});
}

const std::string kAroundSmall = "region { min_mm { x: 22 y: 9 z: 9 } max_mm { x: 34 y: 21 z: 21 } ";

TEST_F(ScannedBoneOfAScene, ARegionHasFineVoxelsAndTheRestSurroundsIt) {
    const ScannedBone bone = boneOf(kAroundSmall + "resample_mm: 0.5 }");
    EXPECT_TRUE(bone.volume.spacing().isConstant(0.5 * kMm));
    EXPECT_EQ(bone.volume.dims(), Eigen::Vector3i::Constant(25));
    EXPECT_TRUE(isBoneAt(bone.volume, small_));
    ASSERT_TRUE(bone.surroundings);
    const Surroundings& rest = *bone.surroundings;
    EXPECT_EQ(rest.volume.dims(), geometry_.dims);
    EXPECT_TRUE((rest.X_VS * large_).isApprox(large_ - Eigen::Vector3d(22, 9, 9) * kMm));
    EXPECT_EQ(rest.rim.region().max, Eigen::Vector3i::Constant(24));
    EXPECT_TRUE(rest.bone.contains(rest.X_VS * Eigen::Vector3d(large_ - Eigen::Vector3d(7.5 * kMm, 0, 0))));
    EXPECT_TRUE(says(bone, "region of 25 x 25 x 25 voxels of 0.5 mm (as the scene asks)"));
    EXPECT_TRUE(says(bone, "neither felt nor milled"));
}

// The ball's surface is known: the spline is nearer to it than the scan's voxels are far apart.
TEST_F(ScannedBoneOfAScene, ARegionsSurfaceIsWhereTheBodysIs) {
    const ScannedBone bone = boneOf(kAroundSmall + "resample_mm: 0.25 }");
    const Pose& X_WV = bone.volume.geometry().X_WV;
    double worst = 0;
    forEachIndex({Eigen::Vector3i::Zero(), bone.volume.dims().array() - 2}, [&](const Eigen::Vector3i& v) {
        const bool is_in = bone.volume.at(v.x(), v.y(), v.z()) >= bone.volume.iso();
        const bool is_next = bone.volume.at(v.x() + 1, v.y(), v.z()) >= bone.volume.iso();
        if (is_in == is_next) return;
        const Eigen::Vector3d p = X_WV * Eigen::Vector3d(bone.volume.spacing().cwiseProduct(
                                             v.cast<double>() + Eigen::Vector3d(0.5, 0, 0)));
        worst = std::max(worst, std::abs((p - small_).norm() - 4 * kMm));
    });
    EXPECT_LT(worst, 0.2 * kMm);
    EXPECT_GT(worst, 0);
}

TEST_F(ScannedBoneOfAScene, ARegionsVoxelsSuitItsBurrs) {
    const ScannedBone alike =
        boneOf(kAroundSmall + "}", "tool { burr_radius_mm: 2 }\ntool { burr_radius_mm: 1.2 }");
    EXPECT_TRUE(alike.volume.spacing().isConstant(0.3 * kMm, 1e-9));
    EXPECT_TRUE(says(alike, "a quarter of the smallest burr's radius of 1.2 mm"));
    const ScannedBone apart =
        boneOf(kAroundSmall + "}", "tool { burr_radius_mm: 3 }\ntool { burr_radius_mm: 0.5 }");
    EXPECT_TRUE(apart.volume.spacing().isConstant(0.375 * kMm, 1e-9));
    EXPECT_TRUE(says(apart, "an eighth of the largest burr's radius of 3 mm"));
}

TEST_F(ScannedBoneOfAScene, APieceIsDroppedFromRegionAndSurroundings) {
    const ScannedBone bone = boneOf(kAroundSmall + "resample_mm: 0.5 } drop_piece: 2 drop_piece: 3");
    bool is_any = false;
    forEachIndex({Eigen::Vector3i::Zero(), bone.volume.dims().array() - 1}, [&](const Eigen::Vector3i& v) {
        is_any = is_any || bone.volume.at(v.x(), v.y(), v.z()) >= bone.volume.iso();
    });
    EXPECT_FALSE(is_any) << "ringing beside what was dropped";
    EXPECT_TRUE(isBoneAt(bone.surroundings->volume, large_));
    EXPECT_FALSE(isBoneAt(bone.surroundings->volume, small_));
}

// The rim of a piece in soft tissue, which it fills in part, stays no shell of bone.
TEST_F(ScannedBoneOfAScene, APieceThatIsDroppedFromTissueLeavesNoShell) {
    std::vector<float> values;
    forEachIndex({Eigen::Vector3i::Zero(), geometry_.dims.array() - 1}, [&](const Eigen::Vector3i& v) {
        const Eigen::Vector3d p = geometry_.spacing.cwiseProduct(v.cast<double>());
        const double of_large = (p - large_).norm() - 8 * kMm, of_small = (p - small_).norm() - 4 * kMm;
        values.push_back(of_large < 0 || of_small < 0 ? 1500.0f : of_small < 0.8 * kMm ? 280.0f : 40.0f);
    });
    values[0] = -1024;
    writeNrrd(folder_ / "scan.nrrd", geometry_, values);
    const ScannedBone bone = boneOf(kAroundSmall + "resample_mm: 0.5 } drop_piece: 2");
    bool is_any = false;
    forEachIndex({Eigen::Vector3i::Zero(), bone.volume.dims().array() - 1}, [&](const Eigen::Vector3i& v) {
        is_any = is_any || bone.volume.at(v.x(), v.y(), v.z()) >= bone.volume.iso();
    });
    EXPECT_FALSE(is_any);
}

TEST_F(ScannedBoneOfAScene, PiecesThatTouchTheRegionAreKept) {
    const ScannedBone bone = boneOf(kAroundSmall + "resample_mm: 0.5 } keep_pieces: TOUCHING_REGION");
    EXPECT_TRUE(isBoneAt(bone.volume, small_));
    EXPECT_FALSE(isBoneAt(bone.surroundings->volume, large_));
}

TEST_F(ScannedBoneOfAScene, RefusesARegionThatIsNone) {
    expectUserError([&] { boneOf("region { min_mm { x: 5 } max_mm { x: 5 y: 1 z: 1 } }"); },
                    {"s.textproto:2", "`volume.region` is empty"});
    expectUserError([&] { boneOf("region { min_mm { x: 500 y: 9 z: 9 } max_mm { x: 534 y: 21 z: 21 } }"); },
                    {"does not lie in the volume"});
    expectUserError([&] { boneOf(kAroundSmall + "resample_mm: 0.01 }"); },
                    {"volume.region.resample_mm", "million"});
}

// A nerve of soft tissue lies 10 mm from all bone: of the tissue around it nothing is kept.
class SoftStructure : public ScannedBoneOfAScene {
  protected:
    SoftStructure() {
        std::vector<float> values;
        std::vector<uint8_t> labels;
        forEachIndex({Eigen::Vector3i::Zero(), geometry_.dims.array() - 1}, [&](const Eigen::Vector3i& v) {
            const Eigen::Vector3d p = geometry_.spacing.cwiseProduct(v.cast<double>());
            values.push_back(p.x() < 6 * kMm ? 1500.0f : 40.0f);
            labels.push_back((p - nerve_).norm() < 2 * kMm ? 7 : 0);
        });
        writeNrrd(folder_ / "scan.nrrd", geometry_, values);
        writeNrrd(folder_ / "labels.nrrd", geometry_, labels);
    }
    Density densityAt(const Eigen::Vector3d& p_W, const std::string& of_volume,
                      const std::string& more) const {
        const VoxelVolume volume = boneOf(of_volume + "label_path: 'labels.nrrd' ", more).volume;
        const Eigen::Vector3d place =
            (volume.geometry().X_WV.inverse() * p_W).cwiseQuotient(volume.spacing());
        const Eigen::Vector3i v = place.array().round().cast<int>();
        return volume.at(v.x(), v.y(), v.z());
    }

    const Eigen::Vector3d nerve_ = Eigen::Vector3d(18, 15, 15) * kMm,
                          aside_ = Eigen::Vector3d(18, 4, 26) * kMm;
    const std::string region_ =
        "region { min_mm { x: 2 y: 2 z: 2 } max_mm { x: 28 y: 26 z: 27 } resample_mm: 0.25 } ";
    const std::string nerve_label_ = "material { name: 'nerve' label: 7 is_protected: true }\n";
    const std::string plain_label_ = "material { name: 'nerve' label: 7 }\n";
};

TEST_F(SoftStructure, IsKeptHoweverFarFromBone) {
    EXPECT_GT(densityAt(nerve_, region_, nerve_label_), 0);
    EXPECT_EQ(densityAt(aside_, region_, nerve_label_), 0);
    EXPECT_EQ(densityAt(nerve_, region_, plain_label_), 0) << "nobody asks about it";
}

// The region ends in the nerve's middle. Labels are drawn half-way to the next voxel.
TEST_F(SoftStructure, IsDrawnWholeWhereTheRegionCutsIt) {
    const std::string half =
        "region { min_mm { x: 2 y: 2 z: 2 } max_mm { x: 18 y: 26 z: 27 } resample_mm: 0.25 } ";
    const ScannedBone bone = boneOf(half + "label_path: 'labels.nrrd' ", nerve_label_);
    const auto& labelled = bone.materials.labelled;
    ASSERT_NE(labelled, nullptr);
    MaterialTable table(2);
    table[1].is_protected = true;
    const auto meshes = meshStructures(labelled->properties, table, labelled->spacing, 0, labelled->X_VL);
    ASSERT_EQ(meshes.size(), 1u);
    Eigen::AlignedBox3d box_W;
    for (const uint32_t index : meshes[0].indices) {
        const PackedVertex& v = meshes[0].vertices[index];
        const Eigen::Vector3f p_V =
            meshes[0].origin + meshes[0].step.cwiseProduct(Eigen::Vector3f(v.x, v.y, v.z));
        box_W.extend(bone.volume.geometry().X_WV * p_V.cast<double>());
    }
    EXPECT_LT(box_W.min().x(), nerve_.x() - 1.3 * kMm);
    EXPECT_GT(box_W.max().x(), nerve_.x() + 1.3 * kMm);
    EXPECT_LT((box_W.sizes() - Eigen::Vector3d::Constant(4 * kMm)).cwiseAbs().maxCoeff(), 1 * kMm);
    EXPECT_EQ(boneOf("label_path: 'labels.nrrd' ", nerve_label_).materials.labelled, nullptr) << "it has all";
    EXPECT_EQ(boneOf(half + "label_path: 'labels.nrrd' ", plain_label_).materials.labelled, nullptr);
}

TEST_F(SoftStructure, IsKeptWhereItIsAZone) {
    const std::string bone = "zone { name: 'bone' role: TARGET material: 'bone' } ",
                      materials = plain_label_ + "material { name: 'bone' from_value: 500 }\n",
                      ball = "shape { sphere { center_mm { x: 18 y: 15 z: 15 } radius_mm: 2 } }";
    const auto zone = [&](const std::string& text) {
        return materials + "assessment { " + bone + "zone { name: 'z' " + text + " } }";
    };
    EXPECT_GT(densityAt(nerve_, region_, zone("role: TARGET material: 'nerve'")), 0);
    EXPECT_GT(densityAt(nerve_, region_, zone("role: PROTECTED " + ball)), 0);
    EXPECT_EQ(densityAt(nerve_, region_, zone("role: CONTEXT " + ball)), 0);
}

// Metal in the small ball, with streaks that reach neither the large one nor other slices.
class MetalInAScene : public ScannedBoneOfAScene {
  protected:
    MetalInAScene() { writeMetal(3071, 0); }
    void writeMetal(float metal, double streaks_hu) {
        std::vector<float> values;
        forEachIndex({Eigen::Vector3i::Zero(), geometry_.dims.array() - 1}, [&](const Eigen::Vector3i& v) {
            const Eigen::Vector3d p = geometry_.spacing.cwiseProduct(v.cast<double>()), from = p - small_;
            const double of_large = (p - large_).norm() - 8 * kMm, of_small = from.norm() - 4 * kMm;
            const bool has_streaks = std::abs(from.z()) < 2.5 * kMm && from.head<2>().norm() < 12 * kMm;
            const double streak =
                has_streaks ? streaks_hu * std::sin(10 * std::atan2(from.y(), from.x())) : 0;
            values.push_back(from.norm() < 2.5 * kMm        ? metal
                             : of_large < 0 || of_small < 0 ? 1200.0f
                                                            : float(40 + streak));
        });
        values[0] = -1024;
        writeNrrd(folder_ / "scan.nrrd", geometry_, values);
    }
    static bool warns(const ScannedBone& bone, const std::string& word) {
        return std::ranges::any_of(bone.warnings, [&](const std::string& warning) {
            return warning.find(word) != std::string::npos;
        });
    }
};

TEST_F(MetalInAScene, IsSaidAndWarnedOfWhereItIsMilled) {
    const ScannedBone whole = boneOf("");
    EXPECT_TRUE(says(whole, "metal: ")) << whole.remarks.back();
    EXPECT_TRUE(warns(whole, "milled as if it were bone"));
    EXPECT_FALSE(warns(whole, "streaks"));
    const ScannedBone dropped = boneOf("drop_piece: 2");
    EXPECT_TRUE(says(dropped, "metal: "));
    EXPECT_FALSE(warns(dropped, "milled as if"));
    const ScannedBone elsewhere =
        boneOf("region { min_mm { x: 5 y: 9 z: 9 } max_mm { x: 18 y: 21 z: 21 } resample_mm: 0.5 }");
    EXPECT_TRUE(says(elsewhere, "metal: "));
    EXPECT_FALSE(warns(elsewhere, "milled as if"));
    EXPECT_TRUE(warns(boneOf(kAroundSmall + "resample_mm: 0.5 }"), "choose another volume.region"));
}

TEST_F(MetalInAScene, IsNotSaidWhereThereIsNone) {
    writeMetal(1500, 200);
    EXPECT_FALSE(says(boneOf(""), "metal"));
    EXPECT_TRUE(boneOf("").warnings.empty());
}

TEST_F(MetalInAScene, WarnsOfStreaksThatCrossWhatIsMilled) {
    writeMetal(3071, 250);
    EXPECT_TRUE(warns(boneOf("drop_piece: 2"), "streaks of metal cross"));
    const std::string region = " } resample_mm: 0.5 } drop_piece: 2";
    EXPECT_TRUE(warns(boneOf("region { min_mm { x: 20 y: 2 z: 12 } max_mm { x: 32 y: 14 z: 18" + region),
                      "streaks of metal cross"));
    EXPECT_FALSE(
        warns(boneOf("region { min_mm { x: 5 y: 8 z: 21 } max_mm { x: 32 y: 20 z: 27" + region), "streaks"))
        << "other slices";
}

TEST_F(MetalInAScene, WarnsOfAScaleThatItStretches) {
    const auto sceneWithout = [&] {
        LoadedScene scene = sceneOf("");
        scene.scene.mutable_volume()->clear_window_high();
        return scene;
    };
    EXPECT_FALSE(warns(readBone(sceneWithout()), "stretches"));
    writeMetal(14000, 0);
    EXPECT_TRUE(
        warns(readBone(sceneWithout()), "stretches the scale of densities to 14000 HU; volume.window_high"));
    EXPECT_FALSE(warns(boneOf(""), "stretches")) << "the scene has a window_high";
}

TEST_F(ScannedBoneOfAScene, LabelsOfARegionMayLieOnTheScansGrid) {
    std::vector<uint8_t> labels;
    forEachIndex({Eigen::Vector3i::Zero(), geometry_.dims.array() - 1},
                 [&](const Eigen::Vector3i& v) { labels.push_back(v.x() > 28 ? 2 : 1); });
    writeNrrd(folder_ / "labels.nrrd", geometry_, labels);
    const ScannedBone bone =
        boneOf(kAroundSmall + "resample_mm: 0.5 } label_path: 'labels.nrrd'",
               "material { name: 'left' label: 1 }\nmaterial { name: 'right' label: 2 }\n");
    ASSERT_EQ(bone.materials.ids.size(), bone.volume.geometry().voxelCount());
    EXPECT_EQ(bone.materials.ids[0], 1);
    EXPECT_EQ(bone.materials.ids[12], 1);  // x = 28 mm
    EXPECT_EQ(bone.materials.ids[14], 2);
}

}  // namespace
}  // namespace bonemill
