// This is the way that a burr's centre goes in a tick, a straight line in V. It is RT-safe.
#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace bonemill {

class BurrWay {
  public:
    // The burr stays here.
    explicit BurrWay(const Eigen::Vector3d& p_VB) noexcept : BurrWay(p_VB, p_VB, 0) {}
    // It goes from one place to another, of which only the last part of at most `longest` counts, in m.
    BurrWay(const Eigen::Vector3d& p_VB_from, const Eigen::Vector3d& p_VB_to, double longest) noexcept
        : to_(p_VB_to) {
        const Eigen::Vector3d way = p_VB_to - p_VB_from;
        const double length = way.norm();
        if (!(length > 0 && longest > 0)) return;
        length_ = std::min(length, longest);
        direction_ = way / length;
    }

    Eigen::Vector3d from() const noexcept { return to_ - length_ * direction_; }
    Eigen::Vector3d middle() const noexcept { return to_ - length_ / 2 * direction_; }
    const Eigen::Vector3d& to() const noexcept { return to_; }
    const Eigen::Vector3d& direction() const noexcept { return direction_; }  // unit
    double length() const noexcept { return length_; }                        // m

  private:
    Eigen::Vector3d to_;
    Eigen::Vector3d direction_ = Eigen::Vector3d::UnitX();
    double length_ = 0;
};

}  // namespace bonemill
