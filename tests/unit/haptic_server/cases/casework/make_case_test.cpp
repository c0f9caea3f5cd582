// A case as a whole: made of a scan that names a patient everywhere, read back as a session would.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "haptic_server/cases/casework/case_request.h"
#include "haptic_server/scans/import/import_volume.h"
#include "haptic_server/scans/nrrd/nrrd_writer.h"
#include "haptic_server/scene/setup/scene_setup.h"
#include "tests/support/planted_patient.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/scans/import/dicom_seg_bytes.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/grid_scan.h"
#include "tests/unit/haptic_server/scans/import/seg_nrrd.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

std::string textOfFile(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
}

class MakeCase : public testing::Test {
  protected:
    MakeCase() {
        fs::create_directories(fs::path(folder_ / "DOE^JOHN"));
        request_.scan = folder_ / "DOE^JOHN/DOE_19610203.nrrd";
        request_.out = folder_ / "case";
        request_.tools = folder_ / "tools.textproto";
        request_.labels = folder_ / "DOE^JOHN/labels.nrrd";
        request_.label_words = {"5=nerve:protected"};
        request_.at_mm = {30, 20, 20};
        request_.size_mm = 16;
        std::ofstream(request_.tools) << "tool { name: '3 mm' burr_radius_mm: 1.5 speed_rpm: 60000 }\n";
        writeScan(request_.scan, [](const Eigen::Vector3i& v) {
            const double d = (Eigen::Vector3d(v.x(), v.y(), v.z()) - Eigen::Vector3d(20, 20, 20)).norm() - 12;
            return int16_t(std::clamp(500 - 700 * d, -1000.0, 1500.0));
        });
        writeScan(request_.labels,
                  [](const Eigen::Vector3i& v) { return int16_t(v.x() > 28 && v.z() == 20 ? 5 : 0); });
    }
    // 40³ voxels of 1 mm.
    static void writeScan(const std::string& file,
                          const std::function<int16_t(const Eigen::Vector3i&)>& value) {
        std::string bytes =
            "NRRD0005\n# DOE^JOHN, born 19610203\ntype: int16\ndimension: 3\nspace: left-posterior-superior\n"
            "sizes: 40 40 40\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nendian: "
            "little\n"
            "encoding: raw\nPatientName:=DOE^JOHN\ncontent: DOE^JOHN at HOSPITAL_X\n\n";
        forEachIndex({{0, 0, 0}, {39, 39, 39}}, [&](const Eigen::Vector3i& v) {
            const auto sample = uint16_t(value(v));
            bytes += char(sample & 0xff);
            bytes += char(sample >> 8);
        });
        writeBytes(file, bytes);
    }
    std::string make() {
        std::ostringstream out;
        makeCase(request_, "test 1", out);
        return out.str();
    }

    test::TemporaryFolder folder_;
    CaseRequest request_;
};

TEST_F(MakeCase, IsASceneThatRunsWithTheSameVoxels) {
    const std::string said = make();
    EXPECT_NE(said.find("iso-value"), std::string::npos) << said;
    EXPECT_NE(said.find("wrote "), std::string::npos);
    const LoadedScene loaded = loadScene(folder_ / "case/case.textproto");
    const SceneSetup simulation = setUpScene(loaded);
    EXPECT_TRUE(simulation.bone->volume.spacing().isConstant(0.375e-3, 1e-9))
        << "a quarter of the burr's radius";
    EXPECT_TRUE(simulation.surroundings);
    EXPECT_EQ(simulation.tools[0].name, "3 mm");
    EXPECT_TRUE(simulation.tick.effects.protected_field);
    EXPECT_LT((simulation.X_WD.position - Eigen::Vector3d(32e-3, 20e-3, 20e-3)).norm(), 0.6e-3);
    EXPECT_TRUE(
        (simulation.X_WD.rotation * Eigen::Vector3d::UnitY()).isApprox(Eigen::Vector3d::UnitX(), 1e-6));
    const RawVolume before = importVolumeHere(request_.scan),
                    after = importVolumeHere(folder_ / "case/scan.nrrd");
    EXPECT_TRUE(before.values == after.values);
    EXPECT_TRUE(before.geometry.X_WV.position.isApprox(after.geometry.X_WV.position));
}

// Voxels of 1 mm are too coarse for the default burr of 1 mm; below the bone's top is a hole along the hand's
// way.
TEST_F(MakeCase, OfAllBoneBeginsWhereItCanBeMilledWithABurrThatFits) {
    request_.at_mm.clear();
    request_.tools.clear();
    request_.task = "Find your way.";
    writeScan(request_.scan, [](const Eigen::Vector3i& v) {
        const Eigen::Vector3d p = v.cast<double>() - Eigen::Vector3d(20, 20, 20);
        const double d = std::max(p.norm() - 12, 4 - p.head<2>().norm());
        return int16_t(std::clamp(500 - 700 * d, -1000.0, 1500.0));
    });
    const std::string said = make();
    EXPECT_NE(said.find("a ball of 8 mm"), std::string::npos) << said;
    EXPECT_EQ(said.find("coarse for a burr"), std::string::npos) << said;
    const LoadedScene loaded = loadScene(folder_ / "case/case.textproto");
    EXPECT_EQ(loaded.scene.task().rfind("Find your way. All of the bone can be milled", 0), 0u);
    const SceneSetup simulation = setUpScene(loaded);
    EXPECT_EQ(simulation.tools[0].name, "8 mm ball");
    EXPECT_DOUBLE_EQ(simulation.tools[0].burr.radius, 4e-3);
    const Eigen::Vector3d bone = simulation.X_WD.position - Eigen::Vector3d(0, 0, 4e-3);
    const Eigen::Vector3i top = (bone * 1e3).array().round().cast<int>();
    EXPECT_GE(simulation.bone->volume.at(top.x(), top.y(), top.z()), simulation.bone->volume.iso());
    EXPECT_GT(bone.z(), 30e-3) << "the bone's top";
    EXPECT_NEAR(loaded.scene.camera().target_mm().z(), bone.z() * 1e3, 0.01);
    EXPECT_EQ(loaded.scene.camera().distance_mm(), 160);
}

TEST_F(MakeCase, TakesSegmentsByTheirNames) {
    request_.labels = folder_ / "DOE^JOHN/labels.seg.nrrd";
    const auto label = [](const Eigen::Vector3i& v, int layer) {
        return int(v.z() == 20 && (layer == 0 ? v.x() > 28 : v.x() > 30));
    };
    writeSegNrrd(request_.labels, {.dims = {40, 40, 40},
                                   .layers = 2,
                                   .segments = segmentLines(0, "canal", 1, 0) +
                                               segmentLines(1, "facial nerve", 1, 1, "1 0.75 0") +
                                               segmentLines(2, "DOE", 9, 1),
                                   .label = label});
    request_.label_words = {"canal", "facial nerve:protected"};
    make();
    const LoadedScene loaded = loadScene(folder_ / "case/case.textproto");
    ASSERT_EQ(loaded.scene.material_size(), 2);
    EXPECT_EQ(loaded.scene.material(0).label_size(), 2) << "alone, and with the nerve in it";
    EXPECT_EQ(loaded.scene.material(1).label_size(), 1);
    EXPECT_EQ(loaded.scene.material(1).color().green(), 0.75);
    EXPECT_TRUE(setUpScene(loaded).tick.effects.protected_field);
    EXPECT_EQ(textOfFile(folder_ / "case/labels.nrrd").find("DOE"), std::string::npos);
    request_.out = folder_ / "other";
    request_.label_words = {"nerve"};
    expectUserError([&] { make(); }, {"no segment \"nerve\"", "canal, facial nerve"});
    request_.label_words = {"1=nerve"};
    expectUserError([&] { make(); }, {"several layers"});
    request_.label_words = {"DOE"};
    expectUserError([&] { make(); }, {"DOE has no voxel"});
}

TEST_F(MakeCase, SaysNothingOfThePatient) {
    request_.figures = folder_ / "case_figures";
    make();
    size_t files = 0;
    std::vector<fs::directory_entry> entries;
    for (const char* const of : {"case", "case_figures"})
        for (const auto& entry : fs::recursive_directory_iterator(folder_ / of)) entries.push_back(entry);
    for (const fs::directory_entry& entry : entries) {
        ++files;
        const std::string text = entry.path().filename().string() + textOfFile(entry.path());
        for (const char* const word : {"DOE", "JOHN", "19610203", "HOSPITAL_X", folder_.path().c_str()})
            EXPECT_EQ(text.find(word), std::string::npos) << word << " in " << entry.path();
    }
    EXPECT_EQ(files, 4u + 5u);
}

// Every text of the scan and of the segmentation names the patient; only what is typed goes into the case.
TEST_F(MakeCase, OfADicomSeriesSaysNothingOfThePatient) {
    request_.scan = test::writePlantedSeries(folder_.path(), test::plantedHu);
    request_.labels = request_.scan + "/QVPLANTED_SEG.dcm";
    DicomSegmentation drawn{
        .rows = 40, .columns = 40, .segments = {{1, "nerve"}, {2, "QVPLANTED"}}, .frames = {}};
    for (const int slice : {19, 20})
        for (const int segment : {1, 2}) {
            DicomSegmentation::Frame frame{segment, "0\\0\\" + std::to_string(slice), {}};
            for (int n = 0; n < 40 * 40; ++n) frame.values.push_back(n % 40 > 27 + segment);
            drawn.frames.push_back(frame);
        }
    writeDicomSeg(request_.labels, drawn);
    request_.label_words = {"nerve:protected"};
    EXPECT_GE(test::plantedUnder(folder_.path()).size(), 40 * test::kPlanted.size()) << "the search works";
    make();
    EXPECT_EQ(test::plantedUnder(folder_ / "case"), std::vector<std::string>());
    const RawVolume scan = importVolumeHere(folder_ / "case/scan.nrrd");
    EXPECT_EQ(scan.values[20 + 40 * (20 + 40 * 20)], 1500) << "it is that scan";
}

TEST(PlantedPatient, IsFoundInPackedBytes) {
    const test::TemporaryFolder folder;
    VolumeGeometry geometry;
    geometry.dims = {24, 24, 24};
    std::vector<uint8_t> values(geometry.voxelCount(), 0);
    std::ranges::copy(std::string("QvPlanted"), values.begin() + 5000);
    NrrdStream<uint8_t> stream(folder / "a.nrrd", geometry);
    stream.append(std::span<const uint8_t>(values));
    stream.close();
    EXPECT_TRUE(test::plantedIn(textOfFile(folder / "a.nrrd")).empty());
    EXPECT_EQ(test::plantedUnder(folder.path()).size(), 1u);
}

TEST_F(MakeCase, SaysWhereItComesFrom) {
    make();
    const auto json = nlohmann::json::parse(textOfFile(folder_ / "case/provenance.json"));
    EXPECT_EQ(json["by"], "test 1");
    EXPECT_EQ(json["scan"]["voxels"], (nlohmann::json{40, 40, 40}));
    EXPECT_EQ(json["scan"]["sha256"].get<std::string>().size(), 64u);
    EXPECT_TRUE(json.contains("iso_value_proposed"));
}

TEST_F(MakeCase, NamesThoseWhoAskForIt) {
    request_.task = "Drill.";
    request_.credit = "Archive of Scans, CC BY 3.0";
    make();
    EXPECT_EQ(loadScene(folder_ / "case/case.textproto").scene.task(),
              "Drill. Scan: Archive of Scans, CC BY 3.0");
    const auto json = nlohmann::json::parse(textOfFile(folder_ / "case/provenance.json"));
    EXPECT_EQ(json["credit"], request_.credit);
}

TEST_F(MakeCase, RefusesTextsThatCannotBeWrittenBeforeItReads) {
    request_.scan = folder_ / "nothing.nrrd";
    request_.credit = "M\xfcller";
    expectUserError([&] { make(); }, {"--credit", "UTF-8"});
    request_.credit.clear();
    request_.out = folder_ / "pieces";
    expectUserError([&] { make(); }, {"two pictures of one name"});
}

TEST_F(MakeCase, MakesNoneThatNoSessionCouldStart) {
    request_.at_mm = {12, 20, 20};  // the nerve is elsewhere
    expectUserError([&] { make(); }, {"finds nothing to protect"});
    EXPECT_FALSE(fs::exists(folder_ / "case"));
}

TEST_F(MakeCase, KnowsThatTheSidesAreNotKnown) {
    std::string bytes = textOfFile(request_.scan);
    const std::string space = "space: left-posterior-superior\n";
    bytes.replace(bytes.find(space), space.size(), "space dimension: 3\n");
    writeBytes(request_.scan, bytes);
    make();
    EXPECT_TRUE(importVolumeHere(folder_ / "case/scan.nrrd").lacks_patient_axes);
}

TEST_F(MakeCase, TouchesNoFolderThatIsThere) {
    fs::create_directory(folder_ / "case");
    std::ofstream(folder_ / "case/notes.txt") << "mine";
    expectUserError([&] { make(); }, {"case", "is there already"});
    EXPECT_EQ(textOfFile(folder_ / "case/notes.txt"), "mine");
}

TEST_F(MakeCase, LeavesNothingOfACaseThatFails) {
    request_.at_mm = {2, 2, 2};
    request_.size_mm = 3;
    expectUserError([&] { make(); }, {"no bone at --at"});
    EXPECT_FALSE(fs::exists(folder_ / "case"));
    EXPECT_FALSE(fs::exists(folder_ / ".part_case"));
}

TEST_F(MakeCase, AsksForWhatIsMissing) {
    request_.labels.clear();
    expectUserError([&] { make(); }, {"--labels FILE"});
    request_.label_words.clear();
    request_.tools = folder_ / "none.textproto";
    expectUserError([&] { make(); }, {"none.textproto"});
    std::ofstream(request_.tools) << "name: 'nothing'\n";
    expectUserError([&] { make(); }, {"holds no tool"});
}

}  // namespace
}  // namespace bonemill
