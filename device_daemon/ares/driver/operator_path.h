// Says where the simulated hand wants the handle, as a function of the scenario's time.
//
// Waypoints are in frame D. Each segment runs along a straight line and one rotation axis with a smoothstep
// in time (3s² - 2s³), which starts and stops at rest. Before the first and after the last waypoint the hand
// rests there. Tremor, if wanted, is three sines per axis between 8 and 12 Hz with fixed phases, so that a
// run can be repeated. Building allocates; at() is const, RT-safe and thread-safe. Units are m, rad, s.
#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/pose.h"

namespace bonemill {

struct Waypoint {
    double time = 0;       // s, strictly increasing along the path
    Pose X_DT;             // wanted handle pose
    uint32_t buttons = 0;  // held from this waypoint on: bit 0 remove, bit 1 add
};

struct HandTarget {
    Pose X_DT;
    Eigen::Vector3d v_DT = Eigen::Vector3d::Zero();  // m/s
    Eigen::Vector3d w_DT = Eigen::Vector3d::Zero();  // rad/s, in D
    uint32_t buttons = 0;
    int waypoint = -1;  // the one last passed, -1 before the first
};

class OperatorPath {
  public:
    // Without a waypoint the hand rests at D's origin for ever. `tremor` is the largest deflection per axis.
    explicit OperatorPath(std::vector<Waypoint> waypoints = {}, double tremor = 0);

    HandTarget at(double t) const noexcept;
    // Returns the time of the last waypoint; 0 without waypoints.
    double duration() const noexcept { return waypoints_.empty() ? 0 : waypoints_.back().time; }

  private:
    HandTarget withoutTremor(double t) const noexcept;
    void addTremor(double t, HandTarget& target) const noexcept;

    std::vector<Waypoint> waypoints_;
    std::vector<Eigen::Vector3d> turns_;  // rotation vector (D) from waypoint i to i + 1
    double tremor_;
};

}  // namespace bonemill
