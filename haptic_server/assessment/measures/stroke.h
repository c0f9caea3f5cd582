// A stroke of the burr, from one place where the hand turns to the next, and what is measured of it. SI,
// frame W. Normal threads; allocates.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <span>
#include <vector>

#include "haptic_server/assessment/measures/motion.h"

namespace bonemill {

inline constexpr double kShortestStroke = 1e-3;  // m: a shorter one is none

// NaN is what such a stroke does not have.
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

}  // namespace bonemill
