#include "common/geometry/pose.h"

#include <cmath>

namespace bonemill {
namespace {
// Below this angle sin and atan2 are replaced by their series: the error is below 1e-18.
constexpr double kSmallAngle_rad = 1e-6;
}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& v) noexcept {
    Eigen::Matrix3d m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
}

Eigen::Quaterniond expRotation(const Eigen::Vector3d& theta) noexcept {
    const double angle = theta.norm();
    const double scale = angle < kSmallAngle_rad ? 0.5 - angle * angle / 48 : std::sin(angle / 2) / angle;
    const Eigen::Vector3d v = scale * theta;
    return {std::cos(angle / 2), v.x(), v.y(), v.z()};
}

Eigen::Vector3d logRotation(const Eigen::Quaterniond& q) noexcept {
    const double sign = q.w() < 0 ? -1.0 : 1.0;
    const Eigen::Vector3d v = sign * q.vec();
    const double sine = v.norm();
    const double cosine = sign * q.w();
    if (sine < kSmallAngle_rad) return 2 * v / cosine;
    return 2 * std::atan2(sine, cosine) / sine * v;
}

}  // namespace bonemill
