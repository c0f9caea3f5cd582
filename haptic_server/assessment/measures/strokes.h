// Cuts a session into strokes and measures them, by the three definitions in use: by turns of the way, by
// contact, and by minima of speed. A definition's name goes with each figure, for their counts differ. SI,
// frame W. One normal thread; what is kept is bounded.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <span>
#include <vector>

#include "haptic_server/assessment/measures/distribution.h"
#include "haptic_server/assessment/measures/motion.h"
#include "haptic_server/assessment/measures/tick_step.h"

namespace bonemill {

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
    double median(double StrokeMeasures::*measure) const;
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

    void add(const MotionSample& sample);
    void finish() { endPeriod(); }
    const StrokeList& strokes() const noexcept { return strokes_; }

  private:
    void judge(size_t at);
    void cutAt(size_t at);
    void endPeriod();

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
    void add(const TickStep& step, double force);
    void finish();
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

    void add(const MotionSample& sample);
    void finish();
    size_t count() const noexcept { return count_; }
    const Distribution& lengths() const noexcept { return lengths_; }  // m

  private:
    void endAt(size_t at);

    std::vector<MotionSample> samples_;
    std::vector<double> speeds_;
    double peak_ = 0;
    int slow_ = 0;  // samples, up to the newest
    size_t count_ = 0;
    Distribution lengths_;
};

}  // namespace bonemill
