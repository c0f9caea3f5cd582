#include "render_client/camera/orbit_camera.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

constexpr double kFitMargin = 1.06;

}  // namespace

void OrbitCamera::setUp(const Eigen::Vector3d& up_W) {
    const double length = up_W.norm();
    up_W_ =
        std::isfinite(length) && length > 1e-9 ? Eigen::Vector3d(up_W / length) : Eigen::Vector3d::UnitZ();
}

void OrbitCamera::orbit(double delta_azimuth, double delta_elevation) {
    azimuth = std::remainder(azimuth + delta_azimuth, 2 * M_PI);
    elevation = std::clamp(elevation + delta_elevation, -kMaxElevation, kMaxElevation);
}

void OrbitCamera::zoom(double factor) {
    distance = std::clamp(distance * factor, kMinDistance, kMaxDistance);
}

void OrbitCamera::pan(double right, double up) {
    const double picture_height = 2 * distance * std::tan(kFieldOfView / 2);
    target_W -= picture_height * (R_WC().col(0) * right + R_WC().col(1) * up);
}

Eigen::Vector3d OrbitCamera::towardsEye_W() const {
    const Eigen::Vector3d anterior = -Eigen::Vector3d::UnitY();
    const bool up_is_anterior = std::abs(up_W_.dot(anterior)) > 0.99;
    const Eigen::Vector3d reference = up_is_anterior ? Eigen::Vector3d::UnitZ() : anterior;
    const Eigen::Vector3d front = (reference - up_W_ * up_W_.dot(reference)).normalized();
    const Eigen::Vector3d left = up_W_.cross(front);
    const double bounded = std::clamp(elevation, -kMaxElevation, kMaxElevation);
    return std::cos(bounded) * (std::cos(azimuth) * front + std::sin(azimuth) * left) +
           std::sin(bounded) * up_W_;
}

Eigen::Matrix3d OrbitCamera::R_WC() const {
    Eigen::Matrix3d axes;
    axes.col(2) = towardsEye_W();
    axes.col(0) = up_W_.cross(axes.col(2)).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    return axes;
}

Camera OrbitCamera::view() const {
    Camera camera;
    camera.eye_W = eye_W();
    camera.R_WC = R_WC();
    camera.field_of_view = kFieldOfView;
    camera.focus = distance;
    return camera;
}

void OrbitCamera::fit(std::span<const Eigen::Vector3d> corners_W, double aspect) {
    if (corners_W.empty()) return;
    Eigen::AlignedBox3d box;
    for (const auto& corner : corners_W) box.extend(corner);
    target_W = box.center();
    const double tangent_y = std::tan(kFieldOfView / 2) / kFitMargin;
    const double tangent_x = tangent_y * aspect;
    double needed = kMinDistance;
    for (const auto& corner : corners_W) {
        const Eigen::Vector3d p_C = R_WC().transpose() * (corner - target_W);
        needed = std::max(
            {needed, p_C.z() + std::abs(p_C.x()) / tangent_x, p_C.z() + std::abs(p_C.y()) / tangent_y});
    }
    distance = std::min(needed, kMaxDistance);
}

}  // namespace bonemill
