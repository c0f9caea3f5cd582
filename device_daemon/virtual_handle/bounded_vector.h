// Bounds the length of a vector; its direction stays. It is RT-safe, for any thread.
#pragma once

#include <Eigen/Core>

namespace bonemill {

inline Eigen::Vector3d bounded(const Eigen::Vector3d& v, double longest) noexcept {
    const double length = v.norm();
    return length > longest ? Eigen::Vector3d(v * (longest / length)) : v;
}

}  // namespace bonemill
