#include "device_daemon/hands/pointer/hand_wish.h"

#include <google/protobuf/stubs/logging.h>

#include <cmath>

#include "common/commands/role_rules.h"
#include "common/device_messages/device_messages.h"
#include "proto/topics.pb.h"

namespace bonemill {
namespace {

constexpr size_t kMaxWishBytes = 4u << 10;  // what a sane message needs many times over

std::optional<Pose> poseIn(const topics::HandPointer& message) {
    if (message.p_wt_m_size() != 3 || message.q_wt_size() != 4) return std::nullopt;
    const auto& q = message.q_wt();
    Pose X_WT{Eigen::Vector3d(message.p_wt_m().data()), Eigen::Quaterniond(q[0], q[1], q[2], q[3])};
    if (!X_WT.isFinite() || X_WT.position.norm() > kMaxDeviceReach ||
        std::abs(X_WT.rotation.norm() - 1) > kQuaternionNormTolerance)
        return std::nullopt;
    X_WT.rotation.normalize();
    return X_WT;
}

}  // namespace

std::optional<HandWish> parseHandWish(std::span<const uint8_t> payload, uint64_t sender) {
    const google::protobuf::LogSilencer silencer;  // a hostile peer must not fill the log
    topics::HandPointer message;
    if (payload.size() > kMaxWishBytes || sender == 0 ||
        !message.ParseFromArray(payload.data(), static_cast<int>(payload.size())) ||
        message.sender() != sender || message.sequence() == 0 || message.epoch() == 0)
        return std::nullopt;
    HandWish wish;
    wish.sender = sender;
    wish.epoch = message.epoch();
    wish.sequence = message.sequence();
    wish.is_holding = message.is_holding();
    wish.may_hold = mayHoldTool(message.role());
    if (!wish.is_holding) return wish;
    const auto X_WT = poseIn(message);
    if (!X_WT) return std::nullopt;
    wish.X_WT = *X_WT;
    wish.placements = message.placements();
    wish.buttons = message.buttons() & (kButtonRemove | kButtonAdd);
    return wish;
}

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
