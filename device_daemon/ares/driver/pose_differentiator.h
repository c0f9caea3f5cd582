// This estimates how fast a handle moves, for a device that says only where it is.
//
// It is the difference of successive poses behind a first-order filter of 50 Hz. A hand moves with less than
// about 10 Hz, which the filter delays by 3 ms. Of a position in steps of 10 µm, sampled at 1 kHz, the plain
// difference jumps by 10 mm/s; the filter leaves 3 mm/s. It is RT-safe, for one thread.
#pragma once

#include <cstdint>

#include "common/geometry/pose.h"

namespace bonemill {

class PoseDifferentiator {
  public:
    // The handle was there at that time (ns of any clock that runs evenly). After a pause, or when the clock
    // jumps back, it starts from rest.
    void take(const Pose& X_DT, int64_t stamp_ns) noexcept;

    const Eigen::Vector3d& v_DT() const noexcept { return v_DT_; }  // m/s
    const Eigen::Vector3d& w_DT() const noexcept { return w_DT_; }  // rad/s, in D

  private:
    bool has_pose_ = false;
    Pose X_DT_;
    int64_t stamp_ns_ = 0;
    Eigen::Vector3d v_DT_ = Eigen::Vector3d::Zero();
    Eigen::Vector3d w_DT_ = Eigen::Vector3d::Zero();
};

}  // namespace bonemill
