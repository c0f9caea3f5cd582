#include "haptic_server/scans/confined/free_memory.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t kMiB = 1 << 20;

// A /proc and trees of control groups that are only files.
class FreeMemoryTest : public testing::Test {
  protected:
    FreeMemoryTest() { write("proc/meminfo", "MemTotal: 9000000 kB\nMemAvailable: 4096000 kB\n"); }

    void write(const fs::path& file, const std::string& text) {
        fs::create_directories((root_ / file).parent_path());
        writeBytes(root_ / file, text);
    }
    // The line of a mount whose root is this part of the tree of groups.
    std::string mount(const std::string& root, const std::string& point, const std::string& rest) const {
        return "31 23 0:28 / / rw - tmpfs tmpfs rw\n35 31 0:32 " + root + " " + (root_ / point).string() +
               " rw,relatime shared:7 - " + rest + "\n";
    }
    void version2(const std::string& group, const std::string& root = "/") {
        write("proc/self/cgroup", "0::" + group + "\n");
        write("proc/self/mountinfo", mount(root, "v2", "cgroup2 cgroup2 rw,nsdelegate"));
    }
    void version1(const std::string& group, const std::string& root = "/") {
        write("proc/self/cgroup", "5:cpu,cpuacct:/other\n4:memory:" + group + "\n0::/\n");
        write("proc/self/mountinfo", mount(root, "v1", "cgroup cgroup rw,memory"));
    }
    void limit2(const std::string& group, const std::string& most, uint64_t used, uint64_t cached = 0) {
        write("v2" + group + "/memory.max", most + "\n");
        write("v2" + group + "/memory.current", std::to_string(used) + "\n");
        write("v2" + group + "/memory.stat",
              "anon 5\ninactive_file " + std::to_string(cached) + "\nslab 7\n");
    }
    void limit1(const std::string& group, uint64_t most, uint64_t used, uint64_t cached = 0) {
        write("v1" + group + "/memory.limit_in_bytes", std::to_string(most) + "\n");
        write("v1" + group + "/memory.usage_in_bytes", std::to_string(used) + "\n");
        write("v1" + group + "/memory.stat",
              "inactive_file 3\ntotal_inactive_file " + std::to_string(cached) + "\n");
    }
    uint64_t freeMiB() { return freeMemory(root_ / "proc").bytes / kMiB; }

    const test::TemporaryFolder folder_;
    const fs::path root_ = folder_.path();
};

TEST_F(FreeMemoryTest, isTheMachinesWithoutGroups) {
    EXPECT_EQ(freeMiB(), 4000u);
    EXPECT_EQ(freeMemory(root_ / "proc").text(), "only 4000 MiB of memory are free");
}

TEST_F(FreeMemoryTest, isLimitedByAGroupOfVersion2) {
    version2("/docker/1");
    limit2("/docker/1", std::to_string(512 * kMiB), 300 * kMiB, 100 * kMiB);
    EXPECT_EQ(freeMiB(), 312u);
    EXPECT_EQ(freeMemory(root_ / "proc").text(),
              "only 312 MiB of memory are free (a limit of 512 MiB on /docker/1)");
    limit2("/docker/1", "max", 300 * kMiB);
    EXPECT_EQ(freeMiB(), 4000u);
}

TEST_F(FreeMemoryTest, isLimitedByTheGroupsAround) {
    version2("/a/b/c");
    limit2("/a/b/c", "max", 100 * kMiB);
    limit2("/a/b", std::to_string(900 * kMiB), 500 * kMiB);
    limit2("/a", std::to_string(1000 * kMiB), 950 * kMiB);
    EXPECT_EQ(freeMiB(), 50u);
    limit2("/a", std::to_string(3000 * kMiB), 950 * kMiB);
    EXPECT_EQ(freeMiB(), 400u);
}

TEST_F(FreeMemoryTest, isLimitedByAGroupOfVersion1) {
    version1("/docker/1");
    limit1("", uint64_t(9223372036854771712), 5000 * kMiB);
    limit1("/docker/1", 512 * kMiB, 500 * kMiB, 88 * kMiB);
    EXPECT_EQ(freeMiB(), 100u);
}

// In a container the mount begins at its group, or the group is not to be seen at all.
TEST_F(FreeMemoryTest, isLimitedInContainersToo) {
    for (const char* group : {"/docker/1", "/docker/1/inner", "/", "/../elsewhere"}) {
        version1(group, "/docker/1");
        limit1("", 512 * kMiB, 500 * kMiB);
        EXPECT_EQ(freeMiB(), 12u) << group;
    }
    version1("/docker/1/inner", "/docker/1");
    limit1("/inner", 300 * kMiB, 297 * kMiB);
    EXPECT_EQ(freeMiB(), 3u);
}

TEST_F(FreeMemoryTest, isNeverUnknownWhereALimitIsReached) {
    version2("/a");
    limit2("/a", std::to_string(100 * kMiB), 200 * kMiB);
    EXPECT_EQ(freeMiB(), 0u);
    EXPECT_FALSE(freeMemory(root_ / "proc").holds(2));
    EXPECT_TRUE(freeMemory(root_ / "nowhere").holds(uint64_t(1) << 60));
}

}  // namespace
}  // namespace bonemill
