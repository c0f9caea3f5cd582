#include "haptic_server/server/session/session_export.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "common/base/user_error.h"
#include "haptic_server/recording/statistics/bone_files.h"
#include "haptic_server/scans/import/import_volume.h"
#include "tests/support/ply_reader.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/core/bone/milled_ball.h"

namespace bonemill {
namespace {

using test::MilledBall;

constexpr double kVoxelMm3 = 0.125;

class SessionExportTest : public testing::Test {
  protected:
    static std::string resultOf(SessionExport& bone_export) {
        for (int n = 0; n < 3000; ++n) {
            if (const auto result = bone_export.takeResult()) return result->text;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return "no result within 30 s";
    }
    std::vector<std::string> filesOf() const {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
            names.push_back(entry.path().filename().string());
        std::sort(names.begin(), names.end());
        return names;
    }
    double meshMm3() const {
        const MeshGrid grid(ball_.bone.volume, ball_.bone.lattice);
        return meshVolume(meshWholeBone(ball_.bone.volume, ball_.bone.lattice), grid) * 1e9;
    }

    test::TemporaryFolder folder_;
    MilledBall ball_;
};

TEST_F(SessionExportTest, WritesTheBoneOfTheMomentThatWasAskedFor) {
    const std::vector<Density> scanned = ball_.densities();
    const double scanned_mm3 = meshMm3();
    ball_.groove(10e-3);
    const std::vector<Density> then = ball_.densities();
    const double then_mm3 = meshMm3();
    SessionExport bone_export(ball_.history, ball_.bone, folder_.path().string());
    ASSERT_EQ(bone_export.begin("cut_1"), std::nullopt);
    ball_.groove(13e-3);  // meanwhile
    EXPECT_EQ(resultOf(bone_export), "done");
    EXPECT_EQ(bone_export.takeResult(), std::nullopt);
    EXPECT_EQ(filesOf(),
              (std::vector<std::string>{"cut_1.nrrd", "cut_1.ply", "cut_1.stl", "cut_1_difference.nrrd"}));

    const RawVolume volume = importVolume(folder_ / "cut_1.nrrd");
    ASSERT_EQ(volume.values.size(), then.size());
    for (size_t n = 0; n < then.size(); ++n) ASSERT_EQ(volume.values[n], then[n]) << n;

    const RawVolume difference = importVolume(folder_ / "cut_1_difference.nrrd");
    const VolumeGeometry& geometry = ball_.bone.volume.geometry();
    EXPECT_EQ(difference.geometry.dims, geometry.dims);
    EXPECT_EQ(difference.geometry.spacing, geometry.spacing);
    EXPECT_EQ(difference.geometry.X_WV.position, geometry.X_WV.position);
    double sum = 0;
    for (size_t n = 0; n < then.size(); ++n) {
        const double exact = (double(scanned[n]) - double(then[n])) * kFullDifference / kMaxDensity;
        ASSERT_NEAR(difference.values[n], exact, 0.5);
        sum += difference.values[n];
    }
    EXPECT_EQ(difference.values.range().low, 0);
    EXPECT_EQ(difference.values.range().high, kFullDifference);
    // The difference is full inside and half at the surface: densities and surfaces tell the same volume.
    const double removed_mm3 = scanned_mm3 - then_mm3;
    EXPECT_GT(removed_mm3, 20);
    EXPECT_NEAR(sum / kFullDifference * kVoxelMm3, removed_mm3, 0.1 * removed_mm3);

    const test::PlyMesh ply = test::readPly(folder_ / "cut_1.ply");
    EXPECT_TRUE(ply.isClosed());
    EXPECT_NEAR(ply.volume(), then_mm3, 1e-4 * then_mm3);
    EXPECT_EQ(std::filesystem::file_size(folder_ / "cut_1.stl"), 84 + 50 * ply.triangles.size());
}

TEST_F(SessionExportTest, WhatWasAddedIsNegative) {
    ball_.groove(6e-3, 17.5e-3, +1);
    SessionExport bone_export(ball_.history, ball_.bone, folder_.path().string());
    ASSERT_EQ(bone_export.begin("more"), std::nullopt);
    EXPECT_EQ(resultOf(bone_export), "done");
    const RawVolume difference = importVolume(folder_ / "more_difference.nrrd");
    EXPECT_EQ(difference.values.range().low, -kFullDifference);
    EXPECT_EQ(difference.values.range().high, 0);
}

TEST_F(SessionExportTest, AnUntouchedBoneHasNoDifference) {
    SessionExport bone_export(ball_.history, ball_.bone, folder_.path().string());
    ASSERT_EQ(bone_export.begin("whole"), std::nullopt);
    EXPECT_EQ(resultOf(bone_export), "done");
    const RawVolume difference = importVolume(folder_ / "whole_difference.nrrd");
    EXPECT_EQ(difference.values.range().low, 0);
    EXPECT_EQ(difference.values.range().high, 0);
}

TEST_F(SessionExportTest, RefusesWhatIsNoNameAndWhatIsThere) {
    SessionExport bone_export(ball_.history, ball_.bone, folder_.path().string());
    for (const char* name :
         {"", ".", "..", "../up", "a/b", "/tmp/x", ".hidden", "-rf", "a b", "a\\b", "n\xc3\xa4"}) {
        const std::string answer = bone_export.begin(name).value_or(Answer()).text;
        EXPECT_EQ(answer.rfind("refused: '", 0), 0u) << name << ": " << answer;
    }
    EXPECT_EQ(bone_export.begin(std::string(65, 'a')).value_or(Answer()).text.rfind("refused: ", 0), 0u);
    EXPECT_TRUE(filesOf().empty());
    ASSERT_EQ(bone_export.begin("a"), std::nullopt);
    EXPECT_EQ(resultOf(bone_export), "done");
    EXPECT_EQ(bone_export.begin("a")->text, "refused: a.stl is there already; give another name");
}

TEST_F(SessionExportTest, OneAtATime) {
    SessionExport bone_export(ball_.history, ball_.bone, folder_.path().string());
    ASSERT_EQ(bone_export.begin("a"), std::nullopt);
    EXPECT_EQ(bone_export.begin("b")->text, "refused: an export is under way; wait for its end");
    EXPECT_EQ(resultOf(bone_export), "done");
    EXPECT_EQ(bone_export.begin("b"), std::nullopt);
}

TEST_F(SessionExportTest, WithoutAFolderEveryNameIsRefused) {
    SessionExport bone_export(ball_.history, ball_.bone, "");
    EXPECT_NE(bone_export.begin("a").value_or(Answer()).text.find("--export-dir"), std::string::npos);
    EXPECT_THROW(SessionExport(ball_.history, ball_.bone, folder_ / "none"), UserError);
}

// No file of this process grows beyond so many bytes, as on a disk that is full.
class FullDisk {
  public:
    explicit FullDisk(rlim_t bytes) : handler_(signal(SIGXFSZ, SIG_IGN)) {
        getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FullDisk() {
        setrlimit(RLIMIT_FSIZE, &before_);
        signal(SIGXFSZ, handler_);
    }

  private:
    rlimit before_{};
    sighandler_t handler_;
};

TEST_F(SessionExportTest, AFullDiskFailsItAndLeavesNothing) {
    SessionExport bone_export(ball_.history, ball_.bone, folder_.path().string());
    {
        const FullDisk full(1000);
        ASSERT_EQ(bone_export.begin("a"), std::nullopt);
        const std::string answer = resultOf(bone_export);
        EXPECT_EQ(answer.rfind("failed: ", 0), 0u) << answer;
        EXPECT_NE(answer.find("part_a.stl"), std::string::npos) << answer;
    }
    EXPECT_TRUE(filesOf().empty());
    ASSERT_EQ(bone_export.begin("a"), std::nullopt);
    EXPECT_EQ(resultOf(bone_export), "done");
}

// Whoever may write into the folder leads no result over another file.
TEST_F(SessionExportTest, APlantedLinkIsNotFollowed) {
    SessionExport bone_export(ball_.history, ball_.bone, folder_.path().string());
    const test::TemporaryFolder elsewhere;
    std::ofstream(elsewhere / "mine") << "mine";
    std::filesystem::create_symlink(elsewhere / "mine", folder_ / ".part_a.nrrd");
    ASSERT_EQ(bone_export.begin("a"), std::nullopt);
    EXPECT_EQ(resultOf(bone_export), "done");
    EXPECT_EQ(std::filesystem::file_size(elsewhere / "mine"), 4u);
    EXPECT_FALSE(std::filesystem::is_symlink(folder_ / "a.nrrd"));
}

TEST_F(SessionExportTest, ANameLikeThatOfAHalfWrittenFileIsSafe) {
    SessionExport bone_export(ball_.history, ball_.bone, folder_.path().string());
    for (const char* name : {"part_a", "a"}) {
        ASSERT_EQ(bone_export.begin(name), std::nullopt);
        EXPECT_EQ(resultOf(bone_export), "done");
    }
    EXPECT_EQ(filesOf().size(), 8u);
}

TEST(BoneFiles, AskingWhetherALinkCanBeWrittenLeavesItAsItIs) {
    const test::TemporaryFolder folder;
    std::filesystem::create_symlink("later.nrrd", folder / "link.nrrd");
    requireReplaceable(folder / "link.nrrd");
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.nrrd"));
    EXPECT_FALSE(std::filesystem::exists(folder / "later.nrrd"));
}

TEST(BoneFiles, AnEndingThatIsNoFormatIsRefusedBeforeTheRun) {
    const test::TemporaryFolder folder;
    EXPECT_NO_THROW(requireReplaceable(SavePaths{folder / "a.nrrd", folder / "a.PLY", folder / "b.nrrd"}));
    EXPECT_NO_THROW(requireReplaceable(SavePaths{"", folder / "a.stl", ""}));
    EXPECT_THROW(requireReplaceable(SavePaths{"", folder / "a.obj", ""}), UserError);
    EXPECT_THROW(requireReplaceable(SavePaths{folder / "a.nii", "", ""}), UserError);
    EXPECT_THROW(requireReplaceable(SavePaths{"", "", folder / "a"}), UserError);
    EXPECT_THROW(requireReplaceable(SavePaths{"", "", folder / "none/a.nrrd"}), UserError);
}

}  // namespace
}  // namespace bonemill
