#include "render_client/peers/igtl_session/igtl_guest.h"

#include <algorithm>
#include <utility>

namespace bonemill::igtl {

bool IgtlGuest::showPiece(BonePieces& bone, int64_t unix_ns, Clock::time_point now) {
    constexpr double kSavedUp_s = 0.25;
    const std::chrono::duration<double> passed = now - std::exchange(credited_, now);
    credit_ = std::min(credit_ + bytes_per_s_ * passed.count(), bytes_per_s_ * kSavedUp_s);
    if (credit_ <= 0 || line_.waitingBytes() > kMostBeforePiece) return false;
    int next = -1;  // of those that are due the one shown longest ago
    for (int piece = 0; piece < BonePieces::kCount; ++piece) {
        const auto n = size_t(piece);
        if (shown_[n] == bone.revision(piece) || now - shown_at_[n] < kPiecePeriod) continue;
        if (next < 0 || shown_at_[n] < shown_at_[size_t(next)]) next = piece;
    }
    if (next < 0) return false;
    const Blob frame = bone.frame(next, unix_ns);
    if (!line_.say(frame, kMostBeforePiece)) return false;
    credit_ -= double(frame->size());
    shown_[size_t(next)] = bone.revision(next);
    shown_at_[size_t(next)] = now;
    return true;
}

}  // namespace bonemill::igtl
