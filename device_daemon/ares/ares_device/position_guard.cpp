#include "device_daemon/ares/ares_device/position_guard.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/ares_kinematics/ares_kinematics.h"
#include "common/base/units.h"

namespace bonemill {
namespace {

constexpr double kJumpSlackSteps = 4;  // of the encoder

}  // namespace

void StuckCheck::restart(const Vector6d& q) noexcept {
    speed_ = {};
    q_last_ = q;
    q_when_it_moved_.fill(q);
    was_fast_when_it_moved_.fill(false);
}

bool StuckCheck::isStuck(const Vector6d& q, double elapsed) noexcept {
    const Vector6d& speed = speed_.update(q, elapsed);
    bool is_stuck = false;
    for (int i = 0; i < 6; ++i) {
        if (q[i] != q_last_[i] || standsAtItsStop(q[i])) {
            q_when_it_moved_[i] = q;
            was_fast_when_it_moved_[i] = std::abs(speed[i]) > kDeadStopSpeed && !standsAtItsStop(q[i]);
        }
        const double others_moved = (q - q_when_it_moved_[i]).cwiseAbs().maxCoeff();
        is_stuck = is_stuck || others_moved > (was_fast_when_it_moved_[i] ? kDeadStopTravel : travel_);
    }
    q_last_ = q;
    return is_stuck;
}

bool StuckCheck::standsAtItsStop(double position) const noexcept {
    return position < kStopMargin || position > stroke_ - kStopMargin;
}

bool FrozenCheck::isFrozen(const Vector6d& q, const Eigen::Vector3d& push, double elapsed) noexcept {
    if (!has_last_ || q != q_last_) {
        has_last_ = true;
        q_last_ = q;
        lowest_push_ = highest_push_ = push;
        changed_for_ = pushed_for_ = 0;
        return false;
    }
    lowest_push_ = lowest_push_.cwiseMin(push);
    highest_push_ = highest_push_.cwiseMax(push);
    if ((highest_push_ - lowest_push_).maxCoeff() > least_push_) changed_for_ += elapsed;
    pushed_for_ = push.norm() > least_push_ ? pushed_for_ + elapsed : 0;
    return changed_for_ > kChangedTime || pushed_for_ > kSteadyTime;
}

bool isAtHome(const Vector6d& q, const Vector6d& q_home, double tolerance) noexcept {
    return ((q - q_home).array().abs() <= tolerance).all();
}

bool isFinite(const JointReading& joints) noexcept {
    return joints.q.allFinite() && joints.q_dot.allFinite() && joints.forces.allFinite();
}

PositionGuard::PositionGuard(const AresKinematics& kinematics, const PositionGuardConfig& config) noexcept
    : kinematics_(kinematics),
      config_(config),
      jump_(config.largest_slider_speed, kJumpSlackSteps * config.encoder_step),
      stuck_(config.stuck_travel, kinematics.geometry().stroke),
      frozen_(config.friction) {
    if (config_.home) {
        config_.X_DT_start = config_.home->X_DT;
        kinematics_.inverse(config_.X_DT_start, q_home_);
    }
}

bool PositionGuard::take(const JointReading& joints, const Eigen::Vector3d& push, double elapsed) noexcept {
    const bool is_homed = (joints.status & kStatusCalibrated) && !(joints.status & kStatusHoming);
    if (!is_homed) {
        is_trusted_ = is_distrusted_ = false;
        cause_ = StopCause::kNone;
        return false;
    }
    if (is_distrusted_) return false;
    since_finite_ += elapsed;
    if (!isFinite(joints)) {
        cause_ = StopCause::kImplausiblePose;
        return false;
    }
    elapsed = sinceLast(joints);
    cause_ = is_trusted_ ? doubtOf(joints.q, push, elapsed) : StopCause::kNone;
    if (cause_ != StopCause::kNone) return distrust(cause_);
    if (!is_trusted_ && !begin(joints.q)) return distrust(StopCause::kImplausiblePose);

    location_ = locate(kinematics_, joints.q, location_.X_DT);
    // The platform may have gone where other assemblies begin; a pose that looks well later proves nothing.
    const bool is_lost = !location_.is_found || (location_.faults & kWorkspaceMirrored) ||
                         location_.singularity_index < kLostSingularityIndex;
    cause_ = refusalOf(location_);
    if (is_lost) return distrust(cause_);
    const Vector6d& differences = speed_.update(joints.q, elapsed);
    q_dot_ = joints.q_dot.isZero(0) ? differences : joints.q_dot;
    return cause_ == StopCause::kNone;
}

// Packets come late or get lost: what the loop has between two of them may be far less than what lies between
// their readings. A clock that stands still, or was set back, counts for nothing.
double PositionGuard::sinceLast(const JointReading& joints) noexcept {
    const double by_joints =
        (double(joints.taken_ns) - double(std::exchange(taken_ns_, joints.taken_ns))) / kNsPerSecond;
    return std::max(std::exchange(since_finite_, 0.0), by_joints);
}

void PositionGuard::reset() noexcept {
    is_distrusted_ = false;
    cause_ = StopCause::kNone;
}

bool PositionGuard::begin(const Vector6d& q) noexcept {
    if (config_.home && !isAtHome(q, q_home_, config_.home->tolerance)) return false;
    q_last_ = q;
    stuck_.restart(q);
    frozen_.restart();
    speed_ = {};
    location_.X_DT = config_.X_DT_start;
    is_trusted_ = true;
    return true;
}

StopCause PositionGuard::doubtOf(const Vector6d& q, const Eigen::Vector3d& push, double elapsed) noexcept {
    const double way = (q - std::exchange(q_last_, q)).cwiseAbs().maxCoeff();
    if (jump_.isJump(way, elapsed)) return StopCause::kPoseJump;
    if (stuck_.isStuck(q, elapsed)) return StopCause::kSensorStuck;
    if (!config_.has_frozen_check || isNearAStop()) frozen_.restart();
    return frozen_.isFrozen(q, push, elapsed) ? StopCause::kSensorStuck : StopCause::kNone;
}

StopCause PositionGuard::refusalOf(const Location& location) const noexcept {
    if (!location.is_found) return StopCause::kImplausiblePose;
    if (location.faults & (kWorkspaceSingular | kWorkspaceMirrored)) return StopCause::kSingularity;
    return location.faults == kWorkspaceOk ? StopCause::kNone : StopCause::kImplausiblePose;
}

bool PositionGuard::isNearAStop() const noexcept {
    return kinematics_.workspaceFaults(location_.X_DT, -kStopMargin) != kWorkspaceOk;
}

bool PositionGuard::distrust(StopCause cause) noexcept {
    cause_ = cause;
    is_distrusted_ = true;
    is_trusted_ = false;
    return false;
}

}  // namespace bonemill
