#include "render_client/subscribe/server_choice.h"

#include <utility>

namespace bonemill {

ServerChoice::Verdict ServerChoice::judge(uint64_t epoch, uint64_t writer, bool is_alive,
                                          Clock::time_point now) {
    if (epoch > epoch_) {
        const bool is_same_server = ours_.contains(writer);
        if (epoch_ != 0 && is_alive && !is_same_server) {
            if (others_.size() < kMostWriters) others_.insert(writer);
            has_refused_ = true;
            hearOther(now);
            return Verdict::kOther;
        }
        epoch_ = epoch;
        if (!is_same_server) before_ = std::exchange(ours_, {});
        has_lost_ = is_same_server && has_refused_;
        others_.clear();
    }
    if (epoch < epoch_) {
        if (is_alive && !ours_.contains(writer) && !before_.contains(writer)) hearOther(now);
        return Verdict::kOlder;
    }
    if (ours_.size() < kMostWriters) ours_.insert(writer);
    return Verdict::kOurs;
}

void ServerChoice::forgetWriters() {
    ours_.clear();
    before_.clear();
    others_.clear();
    has_refused_ = has_lost_ = false;
}

void ServerChoice::hearOther(Clock::time_point now) {
    if (!other_last_ || now - *other_last_ > kOtherUntil) other_since_ = now;
    other_last_ = now;
}

bool ServerChoice::hasOther(Clock::time_point now) const {
    return other_last_ && now - *other_last_ < kOtherUntil && *other_last_ - *other_since_ >= kOtherFor;
}

}  // namespace bonemill
