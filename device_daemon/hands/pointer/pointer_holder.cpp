#include "device_daemon/hands/pointer/pointer_holder.h"

namespace bonemill {

std::optional<uint64_t> PointerHolder::holder(int64_t now_ns) const noexcept {
    if (sender_ == 0 || now_ns - heard_ns_ > kSilenceNs) return std::nullopt;
    return sender_;
}

bool PointerHolder::take(const HandWish& wish, int64_t now_ns) noexcept {
    if (!wish.may_hold) return false;
    const auto held_by = holder(now_ns);
    if (!held_by && !wish.is_holding) return false;
    if (held_by && *held_by != wish.sender) return false;
    // The difference wraps around with the counter.
    if (held_by && static_cast<int32_t>(wish.sequence - sequence_) <= 0) return false;
    sender_ = wish.is_holding ? wish.sender : 0;
    sequence_ = wish.sequence;
    heard_ns_ = now_ns;
    return true;
}

}  // namespace bonemill
