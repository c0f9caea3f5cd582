#include "device_daemon/control/safety/motion_monitor.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

// The share that a first-order filter of this time takes of the new value in dt.
double shareOf(double dt, double time) noexcept {
    return std::clamp(dt / time, 0.0, 1.0);
}

}  // namespace

void MotionMonitor::restart() noexcept {
    fast_samples_ = 0;
    power_ = energy_ = mismatched_for_ = 0;
    given_smooth_.setZero();
    applied_smooth_.setZero();
}

StopCause MotionMonitor::check(const DeviceReading& reading, const Wrench& given_D, double dt) noexcept {
    if (isTooFast(reading)) return StopCause::kSpeed;
    if (reading.load >= 1) return StopCause::kOverTemperature;
    if (const StopCause cause = checkPower(reading, given_D, dt); cause != StopCause::kNone) return cause;
    return isMismatched(reading, given_D, dt) ? StopCause::kForceMismatch : StopCause::kNone;
}

bool MotionMonitor::isTooFast(const DeviceReading& reading) noexcept {
    const bool is_fast =
        !(reading.v_DT.norm() <= limits_.max_speed) || !(reading.w_DT.norm() <= limits_.max_angular_speed);
    fast_samples_ = is_fast ? fast_samples_ + 1 : 0;
    return fast_samples_ >= kFastSamples;
}

StopCause MotionMonitor::checkPower(const DeviceReading& reading, const Wrench& given_D, double dt) noexcept {
    const double power = given_D.force.dot(reading.v_DT) + given_D.torque.dot(reading.w_DT);
    if (!std::isfinite(power)) return StopCause::kNone;  // isTooFast() counts such samples
    power_ += shareOf(dt, kPowerTime) * (power - power_);
    energy_ = std::max(0.0, energy_ * (1 - shareOf(dt, kEnergyTime)) + power * dt);
    if (power_ > limits_.max_power) return StopCause::kPower;
    if (energy_ > limits_.max_energy) return StopCause::kEnergy;
    return StopCause::kNone;
}

bool MotionMonitor::isMismatched(const DeviceReading& reading, const Wrench& given_D, double dt) noexcept {
    if (!reading.has_applied) return false;
    const double share = shareOf(dt, kMismatchTime);
    const Eigen::Vector3d ordered = reading.applied_share * given_D.force;
    given_smooth_ += share * (ordered - given_smooth_);
    applied_smooth_ += share * (reading.applied_D.force - applied_smooth_);
    const double allowed = kMismatchShare * given_smooth_.norm() + kMismatchFloor * limits_.max_force;
    const bool differs = !((applied_smooth_ - given_smooth_).norm() <= allowed);
    mismatched_for_ = differs ? mismatched_for_ + dt : 0;
    return mismatched_for_ > kMismatchLasts;
}

double MotionMonitor::warmShare(double load) noexcept {
    if (!(load > kWarmLoad)) return 1;
    const double way = std::min((load - kWarmLoad) / (1 - kWarmLoad), 1.0);
    return 1 - way * (1 - kMinShare);
}

}  // namespace bonemill
