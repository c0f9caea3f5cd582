// What the measures of technique look at: the scene, one tick after the other, and what a hand does, at a
// fixed rate and without tremor beyond 10 Hz, so that the loop's rate does not matter. SI, frame W. One
// normal thread; add() allocates nothing.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "haptic_server/core/telemetry/effect_record.h"
#include "haptic_server/core/telemetry/tick_record.h"

namespace bonemill {

// What the measures of technique must know of the scene.
struct TechniqueScene {
    RecordedEffects recorded;            // what the records hold
    std::vector<std::string> materials;  // names, in the scene's order
    std::vector<bool> are_protected;     // of the materials; those that are not named here are not
    std::vector<std::string> tools;      // names, in the scene's order
    // In contact, a force beyond this is too much; 0: no such limit.
    double force_limit = 0;  // N

    bool isProtected(size_t material) const {
        return material < are_protected.size() && are_protected[material];
    }
};

// One tick as the measures of technique look at it: its record, and the time since the one before.
struct TickStep {
    const TickRecord& record;
    double dt;  // s since the tick before; 0: the first one, or time was lost in between

    double t() const noexcept { return record.t_s; }
    bool isInContact() const noexcept { return record.contacts > 0; }
    Eigen::Vector3d p_W() const noexcept { return Eigen::Map<const Eigen::Vector3d>(record.p_WT); }
    Eigen::Vector3d f_W() const noexcept { return Eigen::Map<const Eigen::Vector3d>(record.f_hand_W); }
    double force() const noexcept { return f_W().norm(); }
    Eigen::Vector3d axis_W() const noexcept {  // along the shaft to the hand
        const double(&q)[4] = record.q_WT;
        return Eigen::Quaterniond(q[0], q[1], q[2], q[3]) * Eigen::Vector3d::UnitY();
    }
    // To the nearest protected structure, m; nothing below infinity where none is in reach.
    double distance() const noexcept {
        return record.effects.protected_id != 0 ? double(record.effects.protected_distance)
                                                : std::numeric_limits<double>::infinity();
    }
};

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

// Each place is the mean of the ticks around it, weighted with a sinc of 10 Hz (-6 dB) under a Hann window of
// 0.2 s to either side: symmetric, hence without delay of phase; the sample comes 0.2 s later.
class Motion {
  public:
    static constexpr double kCutOff = 10;      // Hz
    static constexpr double kHalfWidth = 0.2;  // s

    // `see` gets each sample, in the order of time.
    explicit Motion(std::function<void(const MotionSample&)> see) : see_(std::move(see)) {}

    void add(const TickStep& step) {
        const double place = step.t() * MotionSample::kRate;
        const auto here = int64_t(std::llround(place));
        if (step.dt <= 0) {
            finish();
            next_ = last_ = here;
            has_begun_ = true;
            follows_ = false;
            return;
        }
        const auto first = std::max(next_, int64_t(std::ceil(place - kSlotsPerSide)));
        while (next_ < first) emit(next_++);
        const Eigen::Vector3d p_W = step.p_W(), axis_W = step.axis_W();
        for (int64_t number = first; number <= int64_t(std::floor(place + kSlotsPerSide)); ++number) {
            const double weight = weightAt(double(number) / MotionSample::kRate - step.t()) * step.dt;
            Slot& to = slot(number);
            to.weight += weight;
            to.p_W += weight * p_W;
            to.axis_W += weight * axis_W;
        }
        Slot& own = slot(here);
        own.time += step.dt;
        own.force_time += step.force() * step.dt;
        own.contact_time += step.isInContact() ? step.dt : 0;
        own.removed += step.record.removed;
        own.distance = std::min(own.distance, step.distance());
        last_ = here;
    }
    // No tick comes any more: what is left goes out.
    void finish() {
        if (!has_begun_) return;
        while (next_ <= last_) emit(next_++);
        slots_ = {};
        has_begun_ = false;
    }

  private:
    struct Slot {
        double weight = 0;
        Eigen::Vector3d p_W = Eigen::Vector3d::Zero(), axis_W = Eigen::Vector3d::Zero();
        double time = 0, force_time = 0, contact_time = 0, removed = 0;
        double distance = std::numeric_limits<double>::infinity();
    };
    static constexpr double kSlotsPerSide = kHalfWidth * MotionSample::kRate;
    static constexpr int64_t kSlots = 32;  // a power of two, more than 2 * kHalfWidth * kRate + 2
    Slot& slot(int64_t number) { return slots_[size_t(number & (kSlots - 1))]; }
    static double weightAt(double t) noexcept {
        const double x = 2 * std::numbers::pi * kCutOff * t;
        const double sinc = std::abs(x) < 1e-9 ? 1 : std::sin(x) / x;
        const double cosine = std::cos(0.5 * std::numbers::pi * t / kHalfWidth);
        return sinc * cosine * cosine;
    }
    // A place is known where ticks ran.
    void emit(int64_t number) {
        const Slot done = std::exchange(slot(number), Slot{});
        if (done.time <= 0 || done.weight <= 0) {
            follows_ = false;
            return;
        }
        MotionSample sample;
        sample.t = double(number) / MotionSample::kRate;
        sample.follows = std::exchange(follows_, true);
        sample.p_W = done.p_W / done.weight;
        const double norm = done.axis_W.norm();
        if (norm > 0) sample.axis_W = done.axis_W / norm;
        sample.force = done.force_time / done.time;
        sample.contact = done.contact_time / done.time;
        sample.removed = done.removed;
        sample.distance = done.distance;
        see_(sample);
    }

    std::function<void(const MotionSample&)> see_;
    std::array<Slot, kSlots> slots_{};
    int64_t next_ = 0;  // that goes out
    int64_t last_ = 0;  // that ticks were in
    bool has_begun_ = false, follows_ = false;
};

}  // namespace bonemill
