#include "device_daemon/ares/driver/pose_differentiator.h"

#include <cmath>

#include "common/base/units.h"
#include "common/rt/clock.h"

namespace bonemill {
namespace {

constexpr double kCutOff_hz = 50;
constexpr int64_t kLongestPauseNs = 100 * kNsPerMillisecond;

}  // namespace

void PoseDifferentiator::take(const Pose& X_DT, int64_t stamp_ns) noexcept {
    const int64_t passed_ns = nsBetween(stamp_ns_, stamp_ns);
    if (has_pose_ && passed_ns == 0) return;
    if (!has_pose_ || passed_ns < 0 || passed_ns > kLongestPauseNs) {
        v_DT_.setZero();
        w_DT_.setZero();
    } else {
        const double dt = secondsOfNs(passed_ns);
        const double share = -std::expm1(-kTurn * kCutOff_hz * dt);
        v_DT_ += share * ((X_DT.position - X_DT_.position) / dt - v_DT_);
        w_DT_ += share * (logRotation(X_DT.rotation * X_DT_.rotation.conjugate()) / dt - w_DT_);
    }
    has_pose_ = true;
    X_DT_ = X_DT;
    stamp_ns_ = stamp_ns;
}

}  // namespace bonemill
