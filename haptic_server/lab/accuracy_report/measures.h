// Runs ticks along a path of device poses, and tells a run and the truth apart along the same path. It
// computes in SI, has no shared state, and is not RT-safe.
#pragma once

#include <span>
#include <vector>

#include "common/geometry/pose.h"
#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/core/telemetry/tick_record.h"
#include "haptic_server/core/tick/tick_config.h"

namespace bonemill {

using PosePath = std::vector<Pose>;  // device poses X_WT, one per tick
using RunRecords = std::vector<TickRecord>;

// The same work was run several times: compute_ns of the records is the shortest time of each tick, so that
// what other programs took of the processor does not count; how much that may be, the longest times say.
struct TimedRun {
    RunRecords records;
    std::vector<int64_t> longest_ns;  // of each tick

    explicit TimedRun(RunRecords first);
    void add(const RunRecords& again);  // of the same work
};
inline constexpr int kPasses = 3;

// Runs the path kPasses times. Nothing is milled.
TimedRun runPathTimed(const FixedTickConfig& config, BoneModel& bone, std::span<const Pose> path_WT);

// What the probes of the report have in common.
constexpr double kHeaviestShare = 0.6;    // of the coupling's saturation: no probe presses harder
constexpr int kLeafCells = 16;            // along each edge of a leaf
constexpr int kUnlimitedSamples = 32768;  // what is near the burr, or touches it, is always fewer

// One tick answers with the tool's pose in W, and with what the hand feels (axes W).
struct TickAnswer {
    Pose X_WT;
    Wrench hand_W;
};
std::vector<TickAnswer> answersOf(const RunRecords& records);

// These are root mean squares of the differences to the truth over the ticks in which the true force is at
// least kFeltForce. Magnitudes are relative to the root mean square of the true ones, so that light touches
// do not count as large errors.
struct Errors {
    static constexpr double kFeltForce = 0.2;  // N

    double force_vector = 0;  // of 1: |difference of the forces|; what the settings are ranked by
    double worst = 0;         // of 1: the same in the worst tick
    double force = 0;         // of 1
    double torque = 0;        // of 1; 0 where the truth has no torque
    double direction = 0;     // rad between the forces
    double position = 0;      // m
    double rotation = 0;      // rad
    size_t ticks = 0;
};

// Adds up over several paths.
class ErrorSum {
  public:
    // Both are of the same path and have the same length.
    void add(const std::vector<TickAnswer>& answers, const std::vector<TickAnswer>& truth);
    Errors errors() const;

  private:
    double force_vector_ = 0, worst_ = 0, force_ = 0, true_force_ = 0, torque_ = 0, true_torque_ = 0,
           direction_ = 0, position_ = 0, rotation_ = 0;
    size_t ticks_ = 0;
};

// This is the root mean square of the second differences of the force, in N: what of it is not smooth from
// tick to tick, if the path is smooth.
class NoiseSum {
  public:
    void add(const std::vector<TickAnswer>& answers);
    double noise() const;

  private:
    double sum_ = 0;
    size_t count_ = 0;
};

// The hand has put this energy into the algorithm along a path of device poses that starts in the air, in J
// (trapezoidal rule, force and torque). A passive algorithm never lets it fall below zero. A closed path that
// ends in the air must give `at_end` >= 0.
struct PathEnergy {
    double lowest = 0;  // anywhere on the path, its start included
    double at_end = 0;
};
PathEnergy energyOf(const std::vector<TickAnswer>& answers, std::span<const Pose> device);

}  // namespace bonemill
