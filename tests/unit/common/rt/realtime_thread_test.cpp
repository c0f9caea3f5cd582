#include <gtest/gtest.h>
#include <unistd.h>

#include <stdexcept>

#include "common/base/user_error.h"
#include "common/rt/realtime.h"

namespace bonemill {
namespace {

// No machine has it, so that something is always missing.
constexpr int kNoSuchCore = 100'000;

TEST(RealtimeThread, whenStrictNoWorkBeginsWhereSomethingIsMissing) {
    bool has_begun = false, was_told = false;
    const auto start = [&] {
        RealtimeThread(
            {.request = {.priority = 10, .core = kNoSuchCore}, .is_strict = true, .what = "the test's loop"},
            [&] { has_begun = true; }, [&](const RealtimeReport&) { was_told = true; });
    };
    try {
        start();
        FAIL() << "it is real-time without its core";
    } catch (const UserError& error) {
        const std::string message = error.what();
        for (const char* word : {"the test's loop", "no core 100000", "deploy/check-realtime", "--strict-rt"})
            EXPECT_NE(message.find(word), std::string::npos) << word << " in: " << message;
    }
    EXPECT_FALSE(has_begun);
    EXPECT_FALSE(was_told) << "the error says it";
}

TEST(RealtimeThread, whereTellingFailsNoWorkBegins) {
    bool has_begun = false;
    const auto start = [&] {
        RealtimeThread(
            {.request = {.priority = 10, .core = kNoSuchCore}}, [&] { has_begun = true; },
            [](const RealtimeReport&) { throw std::runtime_error("no paper"); });
    };
    EXPECT_THROW(start(), std::runtime_error);
    EXPECT_FALSE(has_begun);
}

TEST(RealtimeThread, otherwiseItWorksAndSaysWhatIsMissing) {
    pid_t worker = -1;
    std::vector<std::string> missing;
    RealtimeThread thread(
        {.request = {.priority = 10, .core = kNoSuchCore}}, [&] { worker = gettid(); },
        [&](const RealtimeReport& report) { missing = report.missing; });
    thread.join();
    EXPECT_EQ(worker, thread.id());
    EXPECT_NE(worker, gettid());
    EXPECT_FALSE(missing.empty());
}

}  // namespace
}  // namespace bonemill
