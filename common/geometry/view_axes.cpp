#include "common/geometry/view_axes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/math/pinned_math.h"

namespace bonemill {
namespace {

Eigen::Vector3d towardsEye(double azimuth, double elevation, const Eigen::Vector3d& up_W) noexcept {
    const Eigen::Vector3d anterior = -Eigen::Vector3d::UnitY();
    const bool up_is_anterior = std::abs(up_W.dot(anterior)) > 0.99;
    const Eigen::Vector3d reference = up_is_anterior ? Eigen::Vector3d::UnitZ() : anterior;
    const Eigen::Vector3d front = (reference - up_W * up_W.dot(reference)).normalized();
    const Eigen::Vector3d left = up_W.cross(front);
    const double bounded = std::clamp(elevation, -kMaxViewElevation, kMaxViewElevation);
    return pinned::cos(bounded) * (pinned::cos(azimuth) * front + pinned::sin(azimuth) * left) +
           pinned::sin(bounded) * up_W;
}

}  // namespace

Eigen::Vector3d unitUp(const Eigen::Vector3d& up_W) noexcept {
    const double length = up_W.norm();
    return std::isfinite(length) && length > 1e-9 ? Eigen::Vector3d(up_W / length) : Eigen::Vector3d::UnitZ();
}

Eigen::Matrix3d viewAxes(double azimuth, double elevation, const Eigen::Vector3d& up_W) noexcept {
    Eigen::Matrix3d axes;
    axes.col(2) = towardsEye(azimuth, elevation, up_W);
    axes.col(0) = up_W.cross(axes.col(2)).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    return axes;
}

}  // namespace bonemill
