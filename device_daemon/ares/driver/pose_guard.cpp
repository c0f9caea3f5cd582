#include "device_daemon/ares/driver/pose_guard.h"

#include <cmath>

#include "common/rt/clock.h"
#include "device_daemon/ares/driver/jump_check.h"

namespace bonemill {
namespace {

constexpr JumpCheck kMaxWay(PoseGuard::kLargestSpeed, PoseGuard::kSlack);
constexpr JumpCheck kLargestTurn(PoseGuard::kLargestSpin, PoseGuard::kAngularSlack);

bool isPose(const Pose& X_DT) noexcept {
    return X_DT.position.norm() <= kMaxDeviceReach &&
           std::abs(X_DT.rotation.norm() - 1) <= kQuaternionNormTolerance;
}

}  // namespace

bool PoseGuard::take(const Pose& X_DT, int64_t stamp_ns, bool is_calibrated) noexcept {
    if (!is_calibrated) {
        reset();
        return isPose(X_DT);
    }
    if (is_distrusted_) return false;
    if (!isPose(X_DT)) {
        cause_ = StopCause::kImplausiblePose;
        return false;
    }
    is_distrusted_ = has_last_ && hasJumped(X_DT, stamp_ns);
    cause_ = is_distrusted_ ? StopCause::kPoseJump : StopCause::kNone;
    has_last_ = true;
    X_DT_ = X_DT;
    stamp_ns_ = stamp_ns;
    return !is_distrusted_;
}

void PoseGuard::reset() noexcept {
    has_last_ = is_distrusted_ = false;
    cause_ = StopCause::kNone;
}

bool PoseGuard::hasJumped(const Pose& X_DT, int64_t stamp_ns) const noexcept {
    const double elapsed = secondsOfNs(nsBetween(stamp_ns_, stamp_ns));
    return kMaxWay.isJump((X_DT.position - X_DT_.position).norm(), elapsed) ||
           kLargestTurn.isJump(X_DT.rotation.angularDistance(X_DT_.rotation), elapsed);
}

}  // namespace bonemill
