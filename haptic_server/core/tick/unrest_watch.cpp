#include "haptic_server/core/tick/unrest_watch.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr double kMeanTime = 0.1;   // s: what changes more slowly is the hand's
constexpr int kLeastCrossings = 2;  // of the mean in a window: 5 Hz, or 2.5 Hz in a circle
// What shakes the hand is not waited for so long as what only dances on the steps of the encoders: that may
// yet come to rest.
constexpr double kMuch = 20;                                 // times what no hand feels
constexpr int kWait[] = {2, 3, 4}, kLongWait[] = {2, 4, 5};  // windows
constexpr double kShrinks = 0.6;                             // over them at most, of a swing that dies
constexpr double kLeastTouching = 0.1;                       // of a window
constexpr double kMostWay = 0.1e-3, kMostWayOfSwing = 0.5;   // m from window to window: the handle stays

}  // namespace

void Alternation::add(const Vector3d& value, double share_of_mean) noexcept {
    if (!has_mean_) mean_ = value;
    has_mean_ = true;
    mean_ += share_of_mean * (value - mean_);
    const Vector3d off = value - mean_;
    sum_ += off.squaredNorm();
    ++count_;
    if (off.squaredNorm() < least_ * least_ / 16) return;
    // What goes round in a circle changes sides, too.
    const double along = side_.dot(off);
    crossings_ += along < 0;
    if (along <= 0) side_ = off;
}

double Alternation::judge(Patience patience) noexcept {
    last_rms_ = count_ > 0 ? std::sqrt(sum_ / count_) : 0;
    const int wait = (last_rms_ > kMuch * least_ ? kWait : kLongWait)[int(patience)];
    const bool goes_on = last_rms_ > least_ && crossings_ >= kLeastCrossings && windows_ >= wait &&
                         last_rms_ > kShrinks * rms_[size_t(wait - 1)];
    std::copy_backward(rms_.begin(), rms_.end() - 1, rms_.end());
    rms_[0] = last_rms_;
    windows_ = std::min(windows_ + 1, kRemembered);
    return goes_on ? last_rms_ : 0;
}

void Alternation::beginWindow() noexcept {
    sum_ = 0;
    count_ = crossings_ = 0;
}

void Alternation::forget(bool with_mean) noexcept {
    beginWindow();
    windows_ = 0;
    if (with_mean) has_mean_ = false;
}

UnrestWatch::UnrestWatch(double dt) noexcept
    : ticks_in_window_(std::max(1, int(std::lround(kWindow / dt)))),
      share_of_mean_(std::min(1.0, dt / kMeanTime)) {}

void UnrestWatch::begin() noexcept {
    force_.forget(true);
    torque_.forget(true);
    is_known_ = false;
    beginWindow();
}

void UnrestWatch::settle() noexcept {
    force_.forget(false);
    torque_.forget(false);
    is_known_ = true;
    beginWindow();
}

void UnrestWatch::expectOtherDevice(bool has_told) noexcept {
    begin();
    has_told_ = has_told;
}

void UnrestWatch::beginWindow() noexcept {
    force_.beginWindow();
    torque_.beginWindow();
    place_sum_.setZero();
    place_squares_ = 0;
    ticks_ = touching_ = 0;
}

Unrest UnrestWatch::add(const Pose& X_VT_device, const Wrench& wrench_hand_V, bool is_touching) noexcept {
    const Vector3d& place = X_VT_device.position;
    if (ticks_ == 0) p_V_first_ = place;
    place_sum_ += place - p_V_first_;
    place_squares_ += (place - p_V_first_).squaredNorm();
    force_.add(wrench_hand_V.force, share_of_mean_);
    torque_.add(wrench_hand_V.torque, share_of_mean_);
    touching_ += is_touching;
    if (++ticks_ < ticks_in_window_) return {};
    const Unrest unrest = judge();
    beginWindow();
    return unrest;
}

Unrest UnrestWatch::judge() noexcept {
    const Vector3d mean = place_sum_ / ticks_;
    const double swing = std::sqrt(std::max(0.0, place_squares_ / ticks_ - mean.squaredNorm()));
    const double way = (p_V_first_ + mean - p_V_mean_before_).norm();
    p_V_mean_before_ = p_V_first_ + mean;
    if (touching_ < kLeastTouching * ticks_ || way > kMostWay + kMostWayOfSwing * swing) {
        force_.forget(false);
        torque_.forget(false);
        return {};
    }
    Unrest unrest;
    const Patience patience = is_known_ ? Patience::kNone : has_told_ ? Patience::kGreat : Patience::kUsual;
    unrest.force_rms = force_.judge(patience);
    unrest.torque_rms = torque_.judge(patience);
    if (force_.isQuiet() && torque_.isQuiet()) is_known_ = false;
    return unrest;
}

}  // namespace bonemill
