// Cuts a session into strokes and measures them, by the three definitions in use: by turns of the way, by
// contact, and by minima of speed. A definition's name goes with each figure, for their counts differ. SI,
// frame W. One normal thread; what is kept is bounded.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "haptic_server/assessment/measures/distribution.h"
#include "haptic_server/assessment/measures/motion.h"

namespace bonemill {

// How smooth a discrete movement is, from its speed at a fixed rate: S. Balasubramanian's measures, as his
// program computes them (github.com/siva82kb/SPARC, scripts/smoothness.py).

// Spectral arc length: the nearer to 0 the smoother. NaN for a movement without speed. `rate` in Hz.
double sparc(std::span<const double> speed, double rate);
// Log dimensionless jerk: the larger the smoother. NaN for less than three samples, or without change of
// acceleration.
double logDimensionlessJerk(std::span<const double> speed, double rate);
// The frequency (Hz) below which 95 % of the power of the speed lies. NaN for a movement without speed.
double motionFrequency95(std::span<const double> speed, double rate);

inline constexpr double kShortestStroke = 1e-3;  // m: a shorter one is none

// What is measured of a stroke of the burr, from one place where the hand turns to the next; NaN is what such
// a stroke does not have.
struct StrokeMeasures {
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    double length = 0;      // m, of the way
    double duration = 0;    // s
    double mean_speed = 0;  // m/s
    double mean_force = 0;  // N
    double removed = 0;     // m³
    double sparc = kNone, ldlj = kNone;
    double f95 = kNone;  // Hz
};

// The samples follow one another; there are two at least.
double wayOf(std::span<const MotionSample> samples) noexcept;
StrokeMeasures measuresOf(std::span<const MotionSample> samples);

// Of each definition of a stroke, those of a session: as many as this exactly, and of the rest their number.
class StrokeList {
  public:
    static constexpr size_t kMaxKept = 20'000;

    void add(const StrokeMeasures& stroke) {
        ++count_;
        if (kept_.size() < kMaxKept) kept_.push_back(stroke);
    }
    size_t count() const noexcept { return count_; }
    // Of those that have it; NaN if none has.
    double median(double StrokeMeasures::*measure) const {
        std::vector<double> values;
        for (const StrokeMeasures& stroke : kept_)
            if (std::isfinite(stroke.*measure)) values.push_back(stroke.*measure);
        if (values.empty()) return StrokeMeasures::kNone;
        const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        if (values.size() % 2 == 1) return *middle;
        return 0.5 * (*middle + *std::max_element(values.begin(), middle));
    }
    std::span<const StrokeMeasures> kept() const noexcept { return kept_; }

  private:
    std::vector<StrokeMeasures> kept_;
    size_t count_ = 0;
};

// Where the way of 60 ms before and that of 60 ms after make more than a right angle, a stroke ends; of
// neighbours that do, at the slowest. Strokes are of periods of drilling, in which no 0.2 s pass without
// removal.
class TurnStrokes {
  public:
    static constexpr int kReach = 3;             // samples, 60 ms
    static constexpr double kLongestGap = 0.2;   // s without removal
    static constexpr size_t kMaxSamples = 1000;  // of a stroke, 20 s: there it is cut

    void add(const MotionSample& sample) {
        const bool is_cutting = sample.removed > 0;
        if (!samples_.empty() && (!sample.follows || samples_.size() - last_cutting_ > kGapSamples))
            endPeriod();
        if (samples_.empty() && !is_cutting) return;
        samples_.push_back(sample);
        if (is_cutting) last_cutting_ = samples_.size() - 1;
        if (samples_.size() > 2 * kReach) judge(samples_.size() - 1 - kReach);
        if (samples_.size() == kMaxSamples) cutAt(samples_.size() - 1);
    }
    void finish() { endPeriod(); }
    const StrokeList& strokes() const noexcept { return strokes_; }

  private:
    static constexpr double kMinReach = 5e-5;  // m: a hand that rests does not turn
    static constexpr auto kGapSamples = size_t(kLongestGap * MotionSample::kRate);

    void judge(size_t at) {
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
    void cutAt(size_t at) {
        const std::span<const MotionSample> stroke(samples_.data(), at + 1);
        if (wayOf(stroke) >= kShortestStroke) strokes_.add(measuresOf(stroke));
        samples_.erase(samples_.begin(), samples_.begin() + std::ptrdiff_t(at));
        samples_.front().removed = 0;  // it is counted
        last_cutting_ = last_cutting_ > at ? last_cutting_ - at : 0;
        slowest_ = 0;
    }
    void endPeriod() {
        if (samples_.empty()) return;
        if (slowest_ != 0 && slowest_ < last_cutting_) cutAt(slowest_);
        const std::span<const MotionSample> stroke(samples_.data(), last_cutting_ + 1);
        if (wayOf(stroke) >= kShortestStroke) strokes_.add(measuresOf(stroke));
        samples_.clear();
        last_cutting_ = slowest_ = 0;
    }

    std::vector<MotionSample> samples_;  // since the last end of a stroke
    size_t last_cutting_ = 0;            // index
    size_t slowest_ = 0;                 // of the turn that is under way; 0: none is
    double slowest_way_ = 0;
    StrokeList strokes_;
};

// Contact begins above 0.1 N on the burr and ends below 0.05 N, if that lasts for 0.1 s.
class ContactBouts {
  public:
    static constexpr double kOn = 0.1, kOff = 0.05;  // N
    static constexpr double kMerged = 0.1;           // s

    // `force` in N, on the burr.
    void add(const TickStep& step, double force) {
        if (!is_on_) {
            if (force <= kOn) return;
            is_on_ = true;
            duration_ = off_ = 0;
        }
        duration_ += step.dt;
        off_ = force < kOff ? off_ + step.dt : 0;
        if (off_ > kMerged) finish();
    }
    void finish() {
        if (!is_on_) return;
        is_on_ = false;
        ++count_;
        durations_.add(std::max(duration_ - off_, Distribution::kSmallest));
    }
    size_t count() const noexcept { return count_; }
    const Distribution& durations() const noexcept { return durations_; }  // s

  private:
    bool is_on_ = false;
    double duration_ = 0, off_ = 0;  // s; off_: of it, since the force fell
    size_t count_ = 0;
    Distribution durations_;
};

// In contact: a stroke ends where the speed is below 15 % of its peak for 60 ms, and the next one begins with
// the slowest of those samples.
class MinimumStrokes {
  public:
    static constexpr double kShare = 0.15;
    static constexpr int kMinSamples = 3;
    static constexpr size_t kMaxSamples = 1000;

    void add(const MotionSample& sample) {
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
    void finish() {
        if (samples_.size() > 1) endAt(samples_.size() - 1);
        samples_.clear();
        speeds_.clear();
        peak_ = 0, slow_ = 0;
    }
    size_t count() const noexcept { return count_; }
    const Distribution& lengths() const noexcept { return lengths_; }  // m

  private:
    void endAt(size_t at) {
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

    std::vector<MotionSample> samples_;
    std::vector<double> speeds_;
    double peak_ = 0;
    int slow_ = 0;  // samples, up to the newest
    size_t count_ = 0;
    Distribution lengths_;
};

}  // namespace bonemill
