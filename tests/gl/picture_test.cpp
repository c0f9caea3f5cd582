#include "common/picture/picture.h"

#include <gtest/gtest.h>

#include "common/base/user_error.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

TEST(WritePng, LeavesOnlyTheFinishedFile) {
    const test::TemporaryFolder folder;
    writePng(Picture(5, 3), folder / "a.png");
    size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        ++files;
        EXPECT_EQ(entry.path().filename(), "a.png");
        EXPECT_GT(entry.file_size(), 50u);
    }
    EXPECT_EQ(files, 1u);
}

TEST(WritePng, AFolderThatIsNotThereIsTheUsersError) {
    EXPECT_THROW(writePng(Picture(2, 2), "/nonexistent/folder/a.png"), UserError);
}

}  // namespace
}  // namespace bonemill
