// deploy/make-case as a teacher calls it: from a DICOM series to a case with pictures.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/integration/deploy/bonemill_rig.h"

namespace bonemill {
namespace {

class MakeCaseScript : public testing::Test {
  protected:
    MakeCaseScript() {
        rig_.useRealPrograms();
        std::filesystem::copy_file(test::sourceDir() + "/deploy/make-case", rig_.programFile("make-case"));
        EXPECT_EQ(test::run({"make_phantom", "block", "--out", rig_.folder() / "block.nrrd", "--size-mm",
                             "12", "12", "8", "--voxel-mm", "0.5"})
                      .exit_code,
                  0);
    }
    test::Finished make(const std::vector<std::string>& more) const {
        std::vector<std::string> words{rig_.programFile("make-case"), rig_.folder() / "block.nrrd", "--out",
                                       rig_.folder() / "case"};
        words.insert(words.end(), more.begin(), more.end());
        return test::run(words);
    }

    test::BonemillRig rig_;
};

TEST_F(MakeCaseScript, MakesACaseWithPictures) {
    const test::Finished made = make({"--tools", "dental", "--at", "0", "0", "-2", "--size-mm", "6"});
    ASSERT_EQ(made.exit_code, 0) << made.out << made.err;
    EXPECT_NE(made.out.find("bonemill start"), std::string::npos) << made.out;
    for (const char* const file :
         {"case.textproto", "scan.nrrd", "provenance.json", "preview.png", "case.png"}) {
        std::error_code error;
        EXPECT_GT(std::filesystem::file_size(rig_.folder() / (std::string("case/") + file), error), 100u)
            << file;
    }
    EXPECT_NE(test::readFile(rig_.folder() / "case/case.textproto").find("round 014"), std::string::npos);
}

TEST_F(MakeCaseScript, SaysWhichToolsThereAre) {
    const test::Finished refused = make({"--tools", "garden"});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find("dental otologic spine"), std::string::npos) << refused.err;
    EXPECT_FALSE(std::filesystem::exists(rig_.folder() / "case"));
}

TEST_F(MakeCaseScript, LeavesTheProgramsOwnRefusal) {
    const test::Finished refused = make({"--iso", "99999"});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find("iso-value"), std::string::npos) << refused.err;
    EXPECT_FALSE(std::filesystem::exists(rig_.folder() / "case"));
}

}  // namespace
}  // namespace bonemill
