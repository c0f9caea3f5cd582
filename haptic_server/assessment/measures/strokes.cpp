#include "haptic_server/assessment/measures/strokes.h"

#include <algorithm>
#include <cmath>

#include "haptic_server/assessment/measures/smoothness.h"

namespace bonemill {
namespace {

constexpr size_t kMinSmoothnessSamples = 5;  // 0.1 s: below that a spectrum says nothing

std::vector<double> speedsOf(std::span<const MotionSample> samples) {
    std::vector<double> speeds(samples.size());
    for (size_t i = 0; i < samples.size(); ++i) {
        const size_t before = i == 0 ? 0 : i - 1, after = std::min(i + 1, samples.size() - 1);
        speeds[i] =
            (samples[after].p_W - samples[before].p_W).norm() / (double(after - before) * MotionSample::kDt);
    }
    return speeds;
}

constexpr double kMinReach = 5e-5;  // m: a hand that rests does not turn
constexpr auto kGapSamples = size_t(TurnStrokes::kLongestGap * MotionSample::kRate);

}  // namespace

double wayOf(std::span<const MotionSample> samples) noexcept {
    double way = 0;
    for (size_t i = 1; i < samples.size(); ++i) way += (samples[i].p_W - samples[i - 1].p_W).norm();
    return way;
}

StrokeMeasures measuresOf(std::span<const MotionSample> samples) {
    StrokeMeasures stroke;
    stroke.length = wayOf(samples);
    stroke.duration = double(samples.size() - 1) * MotionSample::kDt;
    if (stroke.duration > 0) stroke.mean_speed = stroke.length / stroke.duration;
    for (const MotionSample& sample : samples) {
        stroke.mean_force += sample.force / double(samples.size());
        stroke.removed += sample.removed;
    }
    if (samples.size() < kMinSmoothnessSamples) return stroke;
    const std::vector<double> speeds = speedsOf(samples);
    stroke.sparc = sparc(speeds, MotionSample::kRate);
    stroke.ldlj = logDimensionlessJerk(speeds, MotionSample::kRate);
    stroke.f95 = motionFrequency95(speeds, MotionSample::kRate);
    return stroke;
}

double StrokeList::median(double StrokeMeasures::*measure) const {
    std::vector<double> values;
    for (const StrokeMeasures& stroke : kept_)
        if (std::isfinite(stroke.*measure)) values.push_back(stroke.*measure);
    if (values.empty()) return StrokeMeasures::kNone;
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

void TurnStrokes::add(const MotionSample& sample) {
    const bool is_cutting = sample.removed > 0;
    if (!samples_.empty() && (!sample.follows || samples_.size() - last_cutting_ > kGapSamples)) endPeriod();
    if (samples_.empty() && !is_cutting) return;
    samples_.push_back(sample);
    if (is_cutting) last_cutting_ = samples_.size() - 1;
    if (samples_.size() > 2 * kReach) judge(samples_.size() - 1 - kReach);
    if (samples_.size() == kMaxSamples) cutAt(samples_.size() - 1);
}

void TurnStrokes::judge(size_t at) {
    const Eigen::Vector3d before = samples_[at].p_W - samples_[at - kReach].p_W;
    const Eigen::Vector3d after = samples_[at + kReach].p_W - samples_[at].p_W;
    const bool is_turn = before.dot(after) < 0 && before.norm() > kMinReach && after.norm() > kMinReach;
    if (!is_turn) {
        if (slowest_ != 0) cutAt(slowest_);
        return;
    }
    const double way = (samples_[at + 1].p_W - samples_[at - 1].p_W).norm();
    if (slowest_ != 0 && way >= slowest_way_) return;
    slowest_ = at;
    slowest_way_ = way;
}

// The place where one stroke ends is the next one's first.
void TurnStrokes::cutAt(size_t at) {
    const std::span<const MotionSample> stroke(samples_.data(), at + 1);
    if (wayOf(stroke) >= kShortestStroke) strokes_.add(measuresOf(stroke));
    samples_.erase(samples_.begin(), samples_.begin() + std::ptrdiff_t(at));
    samples_.front().removed = 0;  // it is counted
    last_cutting_ = last_cutting_ > at ? last_cutting_ - at : 0;
    slowest_ = 0;
}

void TurnStrokes::endPeriod() {
    if (samples_.empty()) return;
    if (slowest_ != 0 && slowest_ < last_cutting_) cutAt(slowest_);
    const std::span<const MotionSample> stroke(samples_.data(), last_cutting_ + 1);
    if (wayOf(stroke) >= kShortestStroke) strokes_.add(measuresOf(stroke));
    samples_.clear();
    last_cutting_ = slowest_ = 0;
}

void ContactBouts::add(const TickStep& step, double force) {
    if (!is_on_) {
        if (force <= kOn) return;
        is_on_ = true;
        duration_ = off_ = 0;
    }
    duration_ += step.dt;
    off_ = force < kOff ? off_ + step.dt : 0;
    if (off_ > kMerged) finish();
}

void ContactBouts::finish() {
    if (!is_on_) return;
    is_on_ = false;
    ++count_;
    durations_.add(std::max(duration_ - off_, Distribution::kSmallest));
}

void MinimumStrokes::add(const MotionSample& sample) {
    if (!sample.follows || sample.contact < 0.5) finish();
    if (sample.contact < 0.5) return;
    const double speed =
        samples_.empty() ? 0 : (sample.p_W - samples_.back().p_W).norm() * MotionSample::kRate;
    samples_.push_back(sample);
    speeds_.push_back(speed);
    peak_ = std::max(peak_, speed);
    slow_ = speed < kShare * peak_ ? slow_ + 1 : 0;
    if (slow_ < kMinSamples && samples_.size() < kMaxSamples) return;
    const auto first = speeds_.end() - std::max(slow_, 1);
    endAt(size_t(std::min_element(first, speeds_.end()) - speeds_.begin()));
}

void MinimumStrokes::finish() {
    if (samples_.size() > 1) endAt(samples_.size() - 1);
    samples_.clear();
    speeds_.clear();
    peak_ = 0, slow_ = 0;
}

void MinimumStrokes::endAt(size_t at) {
    const double way = wayOf(std::span(samples_.data(), at + 1));
    if (way >= kShortestStroke) {
        ++count_;
        lengths_.add(way);
    }
    samples_.erase(samples_.begin(), samples_.begin() + std::ptrdiff_t(at));
    speeds_.erase(speeds_.begin(), speeds_.begin() + std::ptrdiff_t(at));
    peak_ = *std::ranges::max_element(speeds_);
    slow_ = 0;
}

}  // namespace bonemill
