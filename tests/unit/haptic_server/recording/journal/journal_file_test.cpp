#include "haptic_server/recording/journal/journal_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

#include "common/base/user_error.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

std::string contentOf(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

TEST(JournalFile, HasAllThatCameInOrder) {
    const test::TemporaryFolder folder;
    std::string all;
    {
        JournalFile file(folder / "new/folder/j.mcap");
        for (int n = 0; n < 1000; ++n) {
            const std::string bytes(size_t(n % 97), char('a' + n % 26));
            file.append(bytes);
            all += bytes;
        }
        file.flush();
        EXPECT_EQ(contentOf(file.path()), all) << "as a kill would leave it";
        file.append("end");
        file.finish();
        EXPECT_EQ(file.problem(), "");
    }
    EXPECT_EQ(contentOf(folder / "new/folder/j.mcap"), all + "end");
}

TEST(JournalFile, IsItsUsersAlone) {
    const test::TemporaryFolder folder;
    const mode_t before = umask(0);
    const JournalFile file(folder / "j.mcap");
    umask(before);
    struct stat status {};
    ASSERT_EQ(stat(file.path().c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0600u);
}

TEST(JournalFile, IsLockedAsLongAsItIsWritten) {
    const test::TemporaryFolder folder;
    const auto isLocked = [&] {
        const int other = open((folder / "j.mcap").c_str(), O_RDONLY | O_CLOEXEC);
        const bool is_locked = flock(other, LOCK_SH | LOCK_NB) != 0;
        close(other);
        return is_locked;
    };
    {
        const JournalFile file(folder / "j.mcap");
        EXPECT_TRUE(isLocked());
    }
    EXPECT_FALSE(isLocked());
}

TEST(JournalFile, IsNeverWrittenOverAnother) {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "j.mcap") << "mine";
    EXPECT_THROW(JournalFile(folder / "j.mcap"), UserError);
    EXPECT_EQ(contentOf(folder / "j.mcap"), "mine");
}

// The disk is full, as far as this process is told.
TEST(JournalFile, WhatDoesNotFitIsLeftOutWholeAndSaid) {
    const test::TemporaryFolder folder;
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    JournalFile file(folder / "j.mcap");
    file.append(std::string(600, 'a'));
    file.flush();
    const rlimit little{1000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &little);
    file.append(std::string(600, 'b'));
    file.flush();
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_NE(file.problem(), "");
    file.append("more");
    file.finish();
    EXPECT_EQ(contentOf(folder / "j.mcap"), std::string(600, 'a')) << "nothing torn, nothing after a gap";
}

}  // namespace
}  // namespace bonemill
