#include "render_client/web/gateway/guest_log.h"

#include <spdlog/spdlog.h>

#include <utility>

namespace bonemill::gateway {

// Who was quiet for so long could say everything again.
void GuestLog::forgetTheQuiet(Clock::time_point now) {
    if (now - looked_ < kEach) return;
    looked_ = now;
    std::erase_if(known_,
                  [&](const auto& one) { return now - one.second.spoke > kMaxAtOnceOfOne * kEachOfOne; });
}

void GuestLog::say(Level level, const std::string& who, const std::string& text, Clock::time_point now) {
    const int64_t now_ns = std::chrono::nanoseconds(now.time_since_epoch()).count();
    if (known_.size() >= kMaxKnown) forgetTheQuiet(now);
    const bool is_room = known_.size() < kMaxKnown || known_.contains(who);
    if (!is_room) {
        ++left_out_;
        return;
    }
    One& one = known_[who];
    one.spoke = now;
    if (one.limit.ask(now_ns) < 0 || all_.ask(now_ns) < 0) {
        ++left_out_;
        return;
    }
    const int64_t left_out = std::exchange(left_out_, 0);
    spdlog::log(
        level == Level::kInfo ? spdlog::level::info : spdlog::level::warn, "{}{}", text,
        left_out == 0 ? "" : " (" + std::to_string(left_out) + " lines of guests were left out before)");
}

}  // namespace bonemill::gateway
