#include "render_client/case_window/case_desk/folder_view.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

TEST(FolderView, TellsFoldersScansAndTheRest) {
    const test::TemporaryFolder folder;
    for (const char* const name : {"b", "a", ".hidden"})
        std::filesystem::create_directory(folder.path() / name);
    for (const char* const name : {"x.NRRD", "ct.nii.gz", "disc.zip", "I10", "I20", "notes.txt", ".y.nrrd"})
        std::ofstream(folder / name) << "x";
    const FolderView view = lookInto(folder.path() / "a/..");
    EXPECT_EQ(view.path, std::filesystem::absolute(folder.path()));
    EXPECT_EQ(view.folders, (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(view.scans, (std::vector<std::string>{"ct.nii.gz", "disc.zip", "x.NRRD"}));
    EXPECT_EQ(view.other_files, 3u);
    EXPECT_EQ(view.problem, "");
}

TEST(FolderView, SaysWhyItCannotLook) {
    EXPECT_NE(lookInto("/nowhere/at/all").problem, "");
}

}  // namespace
}  // namespace bonemill
