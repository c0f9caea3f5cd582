// Follows the materials of a scene file from real files to what the effects get.
#include "haptic_server/scene/setup/scene_materials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "haptic_server/scene/setup/scene_setup.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/write_nrrd.h"
#include "tests/unit/haptic_server/scans/import/dicom_seg_bytes.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/seg_nrrd.h"

namespace bonemill {
namespace {

class SceneMaterials : public testing::Test {
  protected:
    // The 20 x 18 x 16 voxels are bone of 1000, in its upper half 2000, with a nerve (label 5) of 0 along x
    // in it.
    SceneMaterials() {
        geometry_.dims = {20, 18, 16};
        geometry_.spacing.setConstant(0.5e-3);
        std::vector<float> values;
        std::vector<uint8_t> labels;
        forEachIndex({Eigen::Vector3i::Zero(), geometry_.dims.array() - 1}, [&](const Eigen::Vector3i& v) {
            values.push_back(isNerve(v) ? 0.0f : v.z() < 8 ? 1000.0f : 2000.0f);
            labels.push_back(isNerve(v) ? 5 : 1);
        });
        writeNrrd(folder_ / "bone.nrrd", geometry_, values);
        writeNrrd(folder_ / "labels.nrrd", geometry_, labels);
        geometry_.dims.z() = 15;
        labels.resize(geometry_.voxelCount());
        writeNrrd(folder_ / "short.nrrd", geometry_, labels);
    }
    static bool isNerve(const Eigen::Vector3i& v) {
        return v.y() >= 8 && v.y() < 10 && v.z() >= 5 && v.z() < 7;
    }
    LoadedScene sceneOf(const std::string& labels, const std::string& text, int iso = 500) const {
        std::ofstream(folder_ / "s.textproto")
            << "volume { path: 'bone.nrrd' iso_value: " << iso
            << " window_low: 0 window_high: 3000\n label_path: '" << labels << "' }\n"
            << text;
        return loadScene(folder_ / "s.textproto");
    }

    test::TemporaryFolder folder_;
    VolumeGeometry geometry_;
};

const std::string kMaterials =
    "material { name: 'soft' below_value: 1500 stiffness_factor: 0.5 }\n"
    "material { name: 'hard' from_value: 1500 specific_energy_j_per_mm3: 2 }\n"
    "material { name: 'nerve' label: 5 is_protected: true }\n";

TEST_F(SceneMaterials, ComeFromValuesAndLabels) {
    const SceneSetup simulation = setUpScene(
        sceneOf("labels.nrrd", kMaterials + "effects { protected_structures { warning_distance_mm: 2 } }"));
    EXPECT_TRUE(simulation.warnings.empty() ||
                simulation.warnings.front().find("no voxel is of") == std::string::npos);
    const EffectConfigs& effects = simulation.tick.effects;
    ASSERT_EQ(effects.materials.size(), 4u);
    EXPECT_EQ(effects.materials[1].stiffness_factor, 0.5);
    EXPECT_TRUE(effects.material_stiffness);
    EXPECT_EQ(effects.materials[1].specific_energy, 0);
    EXPECT_EQ(effects.materials[2].specific_energy, 2e9);
    EXPECT_TRUE(effects.materials[3].is_protected);
    ASSERT_TRUE(effects.properties);
    forEachIndex({Eigen::Vector3i::Zero(), {19, 17, 15}}, [&](const Eigen::Vector3i& v) {
        ASSERT_EQ(effects.properties->material(v), isNerve(v) ? 3 : v.z() < 8 ? 1 : 2) << v.transpose();
        ASSERT_EQ(effects.properties->original(v), simulation.bone->volume.at(v.x(), v.y(), v.z()));
    });
    ASSERT_TRUE(effects.protected_field);
    EXPECT_EQ(effects.protected_field->reach(), 4e-3 + 1e-3 + 1e-3) << "what is measured near it is known";
    // The place is three voxels above the nerve's upper face.
    EXPECT_NEAR(effects.protected_field->at({5e-3, 4e-3, 9 * 0.5e-3}).distance, 1.25e-3, 1e-6);
}

TEST_F(SceneMaterials, AreSeenFartherWhereTheSceneWarnsFarther) {
    const SceneSetup simulation = setUpScene(
        sceneOf("labels.nrrd", kMaterials + "effects { protected_structures { warning_distance_mm: 5 } }"));
    EXPECT_EQ(simulation.tick.effects.protected_field->reach(), 5e-3 + 1e-3 + 1e-3);
}

TEST_F(SceneMaterials, OfEqualStiffnessDoNotAskForTheEffect) {
    const SceneSetup simulation =
        setUpScene(sceneOf("", "material { name: 'hard' from_value: 1500 specific_energy_j_per_mm3: 2 }"));
    EXPECT_FALSE(simulation.tick.effects.material_stiffness);
}

TEST_F(SceneMaterials, WithoutThemNothingIsKept) {
    const SceneSetup simulation = setUpScene(sceneOf("", ""));
    EXPECT_FALSE(simulation.tick.effects.properties);
    EXPECT_FALSE(simulation.tick.effects.protected_field);
    EXPECT_TRUE(simulation.tick.effects.materials.empty());
}

TEST_F(SceneMaterials, ThatNoVoxelHasAreSaidSo) {
    const SceneSetup simulation =
        setUpScene(sceneOf("labels.nrrd", kMaterials + "material { name: 'vessel' label: 6 }"));
    EXPECT_TRUE(std::ranges::any_of(simulation.warnings, [](const std::string& warning) {
        return warning.find("no voxel is of material 'vessel'") != std::string::npos;
    }));
}

// Each of these runs, and means something else than people think.
TEST_F(SceneMaterials, WhatASceneDoesNotMeanIsSaid) {
    const auto isSaid = [&](const std::string& text, int iso, const std::string& words) {
        const SceneSetup simulation = setUpScene(sceneOf("", text, iso));
        return std::ranges::any_of(simulation.warnings, [&](const std::string& warning) {
            return warning.find(words) != std::string::npos;
        });
    };
    const std::string none = "the volume has no bone", cold = "time_removal makes no heat",
                      thin = "the tool's thinnest part has a radius of 0.05 mm";
    const std::string burr =
        "tool { speed_rpm: 20000 burr_radius_mm: 1 shape { sphere { radius_mm: 1 } } }\n";
    const auto cone = [](const std::string& tip) {
        return "tool { burr_kind: CONE burr_radius_mm: 1 burr_tip_radius_mm: " + tip +
               " burr_length_mm: 6 shape { cone { from_mm { y: -3 } to_mm { y: 3 } from_radius_mm: " + tip +
               " to_radius_mm: 1 } } }";
    };
    EXPECT_TRUE(isSaid("", 2500, none));
    EXPECT_FALSE(isSaid("", 500, none));
    EXPECT_FALSE(isSaid("effects { add_material {} }", 2500, none));
    EXPECT_TRUE(isSaid(burr + "effects { time_removal {} thermal {} }", 500, cold));
    EXPECT_FALSE(isSaid(burr + "effects { energy_removal {} thermal {} }", 500, cold));
    const std::string fine = "is too fine for a hot region";
    EXPECT_TRUE(isSaid(burr + "effects { energy_removal {} thermal { cell_mm: 0.25 } }", 500, fine));
    EXPECT_FALSE(isSaid(burr + "effects { energy_removal {} thermal { cell_mm: 0.35 } }", 500, fine));
    EXPECT_TRUE(isSaid(cone("0.05"), 500, thin));
    EXPECT_FALSE(isSaid(cone("0.9"), 500, "thinnest part"));
}

TEST_F(SceneMaterials, LabelsOfAnotherGridAreResampledAndThatIsSaid) {
    const SceneSetup simulation = setUpScene(sceneOf("short.nrrd", kMaterials));
    EXPECT_TRUE(std::ranges::any_of(simulation.remarks, [](const std::string& remark) {
        return remark.find("short.nrrd: labels of 20 x 18 x 15 voxels") != std::string::npos &&
               remark.find("cover 93.8 %") != std::string::npos;
    }));
    const BoneProperties& properties = *simulation.tick.effects.properties;
    EXPECT_EQ(properties.material({10, 8, 5}), 3);
}

// The canal is all around the nerve and in it: of overlapping segments the later material wins.
TEST_F(SceneMaterials, ComeFromSegmentsThatOverlap) {
    const auto label = [](const Eigen::Vector3i& v, int layer) {
        return int(layer == 0 ? v.y() >= 6 && v.y() < 12 && v.z() >= 4 && v.z() < 8 : isNerve(v));
    };
    writeSegNrrd(folder_ / "a.seg.nrrd",
                 {.dims = {20, 18, 16},
                  .voxel_mm = 0.5,
                  .layers = 2,
                  .segments = segmentLines(0, "canal", 1, 0) + segmentLines(1, "facial nerve", 1, 1),
                  .label = label});
    const std::string kCanal = "material { name: 'c' segment: 'canal' }\n",
                      kNerve = "material { name: 'n' segment: 'facial nerve' }\n";
    for (const bool is_nerve_later : {true, false}) {
        const SceneSetup simulation =
            setUpScene(sceneOf("a.seg.nrrd", is_nerve_later ? kCanal + kNerve : kNerve + kCanal));
        const BoneProperties& properties = *simulation.tick.effects.properties;
        forEachIndex({Eigen::Vector3i::Zero(), {19, 17, 15}}, [&](const Eigen::Vector3i& v) {
            const int expected = !label(v, 0) ? 0 : isNerve(v) || !is_nerve_later ? 2 : 1;
            ASSERT_EQ(properties.material(v), expected) << v.transpose();
        });
    }
    expectUserError(
        [&] { setUpScene(sceneOf("a.seg.nrrd", kCanal + "material { name: 'n'\nsegment: 'dura' }")); },
        {"s.textproto:5: field `material[1].segment[0]`", "a.seg.nrrd", "canal, facial nerve"});
    expectUserError([&] { setUpScene(sceneOf("a.seg.nrrd", "material { name: 'n'\nlabel: 1 }")); },
                    {"s.textproto:4: field `material[0].label[0]`", "several layers"});
    expectUserError([&] { setUpScene(sceneOf("labels.nrrd", kCanal)); }, {"labels.nrrd: names no segments"});
}

// A DICOM segmentation on pixels of 0.25 mm and slices of 0.75 mm: resampled, it is where it was drawn.
TEST_F(SceneMaterials, ComeFromADicomSegmentationOnAGridOfItsOwn) {
    DicomSegmentation drawn{
        .rows = 36,
        .columns = 40,
        .pixel_spacing = "0.25\\0.25",
        .spacing_between = "0.75",
        .segments = {{7, "nerve", {32768, 32768, 32768}}, {9, "beside", {65535, 32768, 32768}}},
        .frames = {}};
    for (int k = 0; k < 10; ++k)
        for (const int segment : {7, 9}) {
            DicomSegmentation::Frame frame{segment, "0\\0\\" + std::to_string(0.75 * k), {}};
            for (int n = 0; n < 36 * 40; ++n) frame.values.push_back((n / 40 < 18) == (segment == 7));
            drawn.frames.push_back(frame);
        }
    writeDicomSeg(folder_ / "a.dcm", drawn);
    const LoadedScene loaded = sceneOf("a.dcm",
                                       "material { name: 'n' segment: 'nerve' is_protected: true }\n"
                                       "material { name: 'b' segment: 'beside' color { red: 0.25 } }\n"
                                       "material { name: 'none' label: 1 }\n");
    const SceneSetup simulation = setUpScene(loaded);
    const BoneProperties& properties = *simulation.tick.effects.properties;
    forEachIndex({Eigen::Vector3i::Zero(), {19, 17, 13}}, [&](const Eigen::Vector3i& v) {
        ASSERT_EQ(properties.material(v), v.y() < 9 ? 1 : 2) << v.transpose();
    });
    const scene::Scene shown = shownSceneOf(loaded.scene, simulation.segment_colors);
    EXPECT_NEAR(shown.material(0).color().green(), 0.466, 0.005) << "its segment's";
    EXPECT_EQ(shown.material(1).color().red(), 0.25) << "its own";
    EXPECT_FALSE(shown.material(2).has_color());
    EXPECT_TRUE(wantsVertexMaterials(shown));
    EXPECT_FALSE(loaded.scene.material(0).has_color()) << "the scene is what its file says";
}

TEST_F(SceneMaterials, LabelsThatAreNotThereAreNamedWithTheirLine) {
    expectUserError([&] { setUpScene(sceneOf("none.nrrd", kMaterials)); },
                    {"s.textproto:2: field `volume.label_path`: ", "none.nrrd"});
}

TEST_F(SceneMaterials, ProtectionOfNothingIsRefused) {
    expectUserError(
        [&] {
            setUpScene(sceneOf("labels.nrrd",
                               "material { name: 'nerve' label: 77 is_protected: true }\n"
                               "effects {\n virtual_fixture { } }"));
        },
        {"s.textproto:5: field `effects.virtual_fixture` finds nothing to protect"});
}

}  // namespace
}  // namespace bonemill
