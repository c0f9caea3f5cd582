#include "render_client/web/gateway/guest_log.h"

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <sstream>

namespace bonemill::gateway {
namespace {

// What is logged while it lives.
class HeardLog {
  public:
    HeardLog() : before_(spdlog::default_logger()) {
        spdlog::set_default_logger(std::make_shared<spdlog::logger>(
            "test", std::make_shared<spdlog::sinks::ostream_sink_mt>(text_)));
    }
    ~HeardLog() { spdlog::set_default_logger(before_); }
    long lines() const {
        const std::string text = text_.str();
        return std::ranges::count(text, '\n');
    }
    std::string text() const { return text_.str(); }

  private:
    std::ostringstream text_;
    std::shared_ptr<spdlog::logger> before_;
};

TEST(GuestLog, NeitherOneNorAllFillIt) {
    const HeardLog heard;
    GuestLog log;
    const GuestLog::Clock::time_point start{};
    for (int n = 0; n < 1000; ++n) log.say(GuestLog::Level::kInfo, "Anna", "came", start);
    EXPECT_EQ(heard.lines(), GuestLog::kMaxAtOnceOfOne);
    log.say(GuestLog::Level::kInfo, "Otto", "came", start);
    EXPECT_NE(heard.text().find("came (990 lines of guests were left out before)"), std::string::npos);
    for (int n = 0; n < 100'000; ++n) log.say(GuestLog::Level::kWarning, std::to_string(n), "knocked", start);
    EXPECT_EQ(heard.lines(), GuestLog::kMaxAtOnce);
    log.say(GuestLog::Level::kInfo, "Anna", "came", start + GuestLog::kEachOfOne);
    EXPECT_EQ(heard.lines(), GuestLog::kMaxAtOnce + 1) << "later it may say something again";
}

}  // namespace
}  // namespace bonemill::gateway
