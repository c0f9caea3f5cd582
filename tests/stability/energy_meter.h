// This is the energy that a hand puts into the simulation, from poses and wrenches at
// the ticks (docs/explanation/stability.md).
//
// Both meters take the wrench on the hand and the pose it acts at, and count work done against it as
// positive: on a path that ends where it began, a passive simulation returns at least zero. Torque works on
// the rotation vector of the step. Units are J.
#pragma once

#include <algorithm>

#include "common/geometry/pose.h"

namespace bonemill::test {

// By the trapezium rule this is the energy of the algorithm itself, without the hold between two ticks.
class AlgorithmEnergy {
  public:
    void add(const Pose& pose, const Wrench& wrench_hand) noexcept {
        if (has_last_) {
            const Eigen::Vector3d step = pose.position - pose_.position;
            const Eigen::Vector3d turn = logRotation(pose.rotation * pose_.rotation.conjugate());
            energy_ -= (wrench_hand.force + wrench_.force).dot(step) / 2 +
                       (wrench_hand.torque + wrench_.torque).dot(turn) / 2;
        }
        pose_ = pose;
        wrench_ = wrench_hand;
        has_last_ = true;
        lowest_ = std::min(lowest_, energy_);
    }
    double energy() const noexcept { return energy_; }
    double lowest() const noexcept { return lowest_; }  // so far; never above 0

  private:
    Pose pose_;
    Wrench wrench_;
    bool has_last_ = false;
    double energy_ = 0;
    double lowest_ = 0;
};

// This is what really flows through the handle: the wrench is held from one tick to the next.
class PortEnergy {
  public:
    // The wrench `held` acts on the hand from this pose until the next call.
    void add(const Pose& pose, const Wrench& held) noexcept {
        if (has_last_) {
            energy_ -= held_.force.dot(pose.position - pose_.position) +
                       held_.torque.dot(logRotation(pose.rotation * pose_.rotation.conjugate()));
        }
        pose_ = pose;
        held_ = held;
        has_last_ = true;
    }
    double energy() const noexcept { return energy_; }

    // Holding the force makes this of a spring of `stiffness` pressed by `depth` and released again, both at
    // `speed`: at most K T v X for the hold, and twice that for each tick of delay. Port energy may not fall
    // below minus this.
    static double holdBound(double stiffness, double dt, double speed, double depth, int delay_ticks) {
        return stiffness * dt * speed * depth * (1 + 2 * delay_ticks);
    }

  private:
    Pose pose_;
    Wrench held_;
    bool has_last_ = false;
    double energy_ = 0;
};

}  // namespace bonemill::test
