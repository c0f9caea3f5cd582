#include "common/log/log.h"

#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

TEST(Log, writesOnStderrFromItsLevelUp) {
    setUpLog("the_program", "warn");
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    spdlog::info("not this");
    spdlog::warn("but this");
    const std::string errors = testing::internal::GetCapturedStderr();
    EXPECT_EQ(errors.find("not this"), std::string::npos);
    EXPECT_NE(errors.find("the_program warning but this"), std::string::npos) << errors;
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST(Log, acceptsEveryLevelAgainAndAgain) {
    for (const char* level : {"trace", "debug", "info", "warn", "error", "off"}) {
        EXPECT_NO_THROW(setUpLog("the_program", level)) << level;
    }
    EXPECT_EQ(spdlog::get_level(), spdlog::level::off);
}

TEST(Log, refusesAnUnknownLevel) {
    EXPECT_THROW(setUpLog("the_program", "verbose"), UserError);
    EXPECT_THROW(setUpLog("the_program", ""), UserError);
}

}  // namespace
}  // namespace bonemill
