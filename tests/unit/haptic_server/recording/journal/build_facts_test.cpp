#include "haptic_server/recording/journal/build_facts.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/base/user_error.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

void write(const std::string& path, const std::string& text) {
    std::ofstream(path) << text;
}

// The first is the example of FIPS 180-4.
TEST(BuildFacts, AFilesDigestIsTheUsualOne) {
    const test::TemporaryFolder folder;
    write(folder / "abc", "abc");
    EXPECT_EQ(sha256Of(folder / "abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_THROW(sha256Of(folder / "missing"), UserError);
}

TEST(BuildFacts, AFoldersDigestIsOfAllItsFiles) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directories(folder / "dicom/more");
    write(folder / "dicom/1", "one");
    write(folder / "dicom/more/2", "two");
    const std::string before = sha256Of(folder / "dicom");
    EXPECT_EQ(sha256Of(folder / "dicom"), before);
    write(folder / "dicom/more/2", "owt");
    EXPECT_NE(sha256Of(folder / "dicom"), before);
    write(folder / "dicom/more/2", "two");
    EXPECT_EQ(sha256Of(folder / "dicom"), before);
    std::filesystem::rename(folder / "dicom/1", folder / "dicom/3");
    EXPECT_NE(sha256Of(folder / "dicom"), before);
}

TEST(BuildFacts, NoJournalHasTheNameOfAnother) {
    EXPECT_EQ(newJournalId().size(), 32u);
    EXPECT_NE(newJournalId(), newJournalId());
}

TEST(BuildFacts, SayWhatTheProgramIs) {
    const journal::Build build = buildFacts("1.2 (abc)");
    EXPECT_EQ(build.version(), "1.2 (abc)");
    EXPECT_NE(build.library().find("glibc 2."), std::string::npos);
    EXPECT_FALSE(build.compiler().empty());
    EXPECT_FALSE(build.kernels().empty());
}

}  // namespace
}  // namespace bonemill
