#include "render_client/offscreen/picture.h"

#include <gtest/gtest.h>

#include "common/config/user_error.h"

namespace bonemill {
namespace {

TEST(WritePng, LeavesOnlyTheFinishedFile) {
    const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "bonemill_picture_test";
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    writePng(Picture(5, 3), folder / "a.png");
    size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
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
