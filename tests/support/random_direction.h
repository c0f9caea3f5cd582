#pragma once

#include <Eigen/Core>
#include <random>

namespace bonemill::test {

inline Eigen::Vector3d randomVector(std::mt19937& random) {
    std::normal_distribution<double> normal;
    const double x = normal(random), y = normal(random);
    return {x, y, normal(random)};
}
inline Eigen::Vector3d randomDirection(std::mt19937& random) {
    return randomVector(random).normalized();
}

}  // namespace bonemill::test
