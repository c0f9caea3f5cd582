#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include "common/rt/realtime.h"

namespace bonemill {
namespace {

constexpr size_t kPages = 200;

// Returns what touching each page of `memory` costs this thread.
std::optional<uint64_t> faultsOfTouching(volatile char* memory, size_t page) {
    const auto before = pageFaultsOf(gettid());
    for (size_t n = 0; n < kPages; ++n) memory[n * page] = 1;
    const auto after = pageFaultsOf(gettid());
    if (!before || !after) return std::nullopt;
    return after->minor - before->minor;
}

// The first touch has no bound from above: a sanitizer's shadow pages are counted with it.
TEST(PageFaults, CountsThePagesThatAThreadTouchesFirst) {
    const auto page = size_t(sysconf(_SC_PAGESIZE));
    const size_t size = kPages * page;
    void* memory = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(memory, MAP_FAILED);
    madvise(memory, size, MADV_NOHUGEPAGE);
    const auto first = faultsOfTouching(static_cast<volatile char*>(memory), page);
    const auto again = faultsOfTouching(static_cast<volatile char*>(memory), page);
    munmap(memory, size);
    ASSERT_TRUE(first && again);
    EXPECT_GE(*first, kPages);
    EXPECT_LT(*again, kPages / 4);
}

TEST(PageFaults, ThereIsNoSuchThread) {
    EXPECT_FALSE(pageFaultsOf(-1));
}

}  // namespace
}  // namespace bonemill
