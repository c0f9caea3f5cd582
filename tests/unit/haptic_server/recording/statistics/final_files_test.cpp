#include <gtest/gtest.h>

#include <fstream>

#include "haptic_server/recording/statistics/bone_files.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

struct ResultFile {
    explicit ResultFile(const char* content) {
        if (content) std::ofstream(path) << content;
    }
    std::string content() const {
        std::string text;
        std::ifstream(path) >> text;
        return text;
    }
    size_t filesBeside() const {
        return size_t(std::distance(std::filesystem::directory_iterator(folder.path()), {}));
    }
    // Writes half of it, then fails as on a full disk.
    static void failOn(const std::string& path) {
        std::ofstream(path) << "ha";
        throw UserError(path + ": disk full");
    }

    test::TemporaryFolder folder;
    std::string path = folder / "result";
};

TEST(FinalFiles, TakeThePlaceOfTheFilesOfBefore) {
    for (const char* before : {static_cast<const char*>(nullptr), "before"}) {
        const ResultFile result(before);
        FinalFiles files;
        files.write(result.path, [](const std::string& path) { std::ofstream(path) << "after"; });
        EXPECT_TRUE(files.problems().empty());
        EXPECT_EQ(result.content(), "after");
        EXPECT_EQ(result.filesBeside(), 1u);
    }
}

TEST(FinalFiles, OneThatFailsLeavesTheFileOfBeforeAndTheOthers) {
    const ResultFile result("before"), other(nullptr);
    FinalFiles files;
    files.write(result.path, ResultFile::failOn);
    files.write(other.path, [](const std::string& path) { std::ofstream(path) << "after"; });
    ASSERT_EQ(files.problems().size(), 1u);
    EXPECT_NE(files.problems()[0].find("disk full"), std::string::npos);
    EXPECT_EQ(result.content(), "before");
    EXPECT_EQ(result.filesBeside(), 1u);
    EXPECT_EQ(other.content(), "after");
}

TEST(FinalFiles, LinksAndDevicesStay) {
    const ResultFile result("before");
    const std::string link = result.folder / "link";
    std::filesystem::create_symlink("result", link);
    FinalFiles files;
    files.write(link, [](const std::string& path) { std::ofstream(path) << "after"; });
    files.write("/dev/null", [](const std::string& path) { EXPECT_EQ(path, "/dev/null"); });
    EXPECT_TRUE(files.problems().empty());
    EXPECT_TRUE(std::filesystem::is_symlink(link));
    EXPECT_EQ(result.content(), "after");
}

TEST(FinalFiles, APlantedLinkIsNotFollowed) {
    const ResultFile result(nullptr), mine("mine");
    std::filesystem::create_symlink(mine.path, result.folder / ".part_result");
    FinalFiles files;
    files.write(result.path, [](const std::string& path) { std::ofstream(path) << "after"; });
    EXPECT_EQ(mine.content(), "mine");
    EXPECT_EQ(result.content(), "after");
    EXPECT_FALSE(std::filesystem::is_symlink(result.path));
    // What cannot be taken away costs an error, not that file.
    std::filesystem::create_directory(result.folder / ".part_result");
    files.write(result.path, [](const std::string&) { FAIL() << "there is nothing to write to"; });
    EXPECT_EQ(files.problems().size(), 1u);
    EXPECT_EQ(result.content(), "after");
}

}  // namespace
}  // namespace bonemill
