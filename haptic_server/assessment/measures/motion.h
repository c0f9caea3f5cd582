// What a hand does, at a fixed rate and without tremor beyond 10 Hz: all that is measured of motion is
// measured on this, so that the loop's rate does not matter.
//
// Each place is the mean of the ticks around it, weighted with a sinc of 10 Hz (-6 dB) under a Hann window of
// 0.2 s to either side: symmetric, hence without delay of phase; the sample comes 0.2 s later. SI, frame W.
// One normal thread; add() allocates nothing.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <limits>

#include "haptic_server/assessment/measures/tick_step.h"

namespace bonemill {

struct MotionSample {
    static constexpr double kRate = 50;  // Hz
    static constexpr double kDt = 1 / kRate;

    double t = 0;          // s, of the session
    bool follows = false;  // the one before is kDt earlier; else time was lost between them
    Eigen::Vector3d p_W = Eigen::Vector3d::Zero();      // burr's centre, m
    Eigen::Vector3d axis_W = Eigen::Vector3d::UnitY();  // along the shaft to the hand
    // Over the 20 ms around t:
    double force = 0;                                           // N, mean
    double contact = 0;                                         // share of the time
    double removed = 0;                                         // m³
    double distance = std::numeric_limits<double>::infinity();  // m, least to a structure
};

class Motion {
  public:
    static constexpr double kCutOff = 10;      // Hz
    static constexpr double kHalfWidth = 0.2;  // s

    // `see` gets each sample, in the order of time.
    explicit Motion(std::function<void(const MotionSample&)> see) : see_(std::move(see)) {}

    void add(const TickStep& step);
    // No tick comes any more: what is left goes out.
    void finish();

  private:
    struct Slot {
        double weight = 0;
        Eigen::Vector3d p_W = Eigen::Vector3d::Zero(), axis_W = Eigen::Vector3d::Zero();
        double time = 0, force_time = 0, contact_time = 0, removed = 0;
        double distance = std::numeric_limits<double>::infinity();
    };
    static constexpr int64_t kSlots = 32;  // a power of two, more than 2 * kHalfWidth * kRate + 2
    Slot& slot(int64_t number) { return slots_[size_t(number & (kSlots - 1))]; }
    void emit(int64_t number);

    std::function<void(const MotionSample&)> see_;
    std::array<Slot, kSlots> slots_{};
    int64_t next_ = 0;  // that goes out
    int64_t last_ = 0;  // that ticks were in
    bool has_begun_ = false, follows_ = false;
};

}  // namespace bonemill
