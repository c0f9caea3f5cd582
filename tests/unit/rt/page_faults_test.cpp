#include "common/rt/page_faults.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

namespace bonemill {
namespace {

TEST(PageFaults, CountsThePagesThatAThreadTouchesFirst) {
    constexpr size_t kPages = 200;
    const size_t size = kPages * size_t(sysconf(_SC_PAGESIZE));
    void* memory = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(memory, MAP_FAILED);
    madvise(memory, size, MADV_NOHUGEPAGE);
    const auto before = pageFaultsOf(gettid());
    for (size_t n = 0; n < kPages; ++n) static_cast<volatile char*>(memory)[n * size / kPages] = 1;
    const auto after = pageFaultsOf(gettid());
    munmap(memory, size);
    ASSERT_TRUE(before && after);
    EXPECT_GE(after->minor - before->minor, kPages);
    EXPECT_LT(after->minor - before->minor, 2 * kPages);
    EXPECT_GE(after->major, before->major);
}

TEST(PageFaults, ThereIsNoSuchThread) {
    EXPECT_FALSE(pageFaultsOf(-1));
}

}  // namespace
}  // namespace bonemill
