#include "common/process/work_ahead.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <numeric>
#include <stdexcept>

namespace bonemill {
namespace {

std::vector<int> numbersBelow(int count) {
    std::vector<int> numbers(static_cast<size_t>(count));
    std::iota(numbers.begin(), numbers.end(), 0);
    return numbers;
}

TEST(WorkAhead, ResultsComeInOrderWhateverIsDoneFirst) {
    std::vector<int> taken;
    workAhead(
        numbersBelow(40),
        [](int n) {
            if (n % 3 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
            return 10 * n;
        },
        [&](int n, int result) {
            EXPECT_EQ(result, 10 * n);
            taken.push_back(n);
        });
    EXPECT_EQ(taken, numbersBelow(40));
}

// The first one waits for the second, which one thread would never begin.
TEST(WorkAhead, SeveralAreWorkedAtBesideEachOther) {
    std::atomic<bool> has_second = false;
    workAhead(
        numbersBelow(2),
        [&](int n) {
            if (n == 1) has_second = true;
            while (!has_second) std::this_thread::yield();
            return n;
        },
        [](int, int) {});
    EXPECT_TRUE(has_second);
}

TEST(WorkAhead, TheFirstErrorInOrderIsThrownAndNothingAfterItTaken) {
    std::vector<int> taken;
    const auto work = [](int n) {
        if (n == 5) std::this_thread::sleep_for(std::chrono::milliseconds(20));
        if (n >= 5) throw std::runtime_error(std::to_string(n));
        return n;
    };
    try {
        workAhead(numbersBelow(40), work, [&](int n, int) { taken.push_back(n); });
        FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "5");
    }
    EXPECT_EQ(taken, numbersBelow(5));
}

TEST(WorkAhead, NothingIsDoneWithoutItems) {
    workAhead(
        std::vector<int>(), [](int n) { return n; }, [](int, int) { FAIL(); });
}

}  // namespace
}  // namespace bonemill
