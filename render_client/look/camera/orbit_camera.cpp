#include "render_client/look/camera/orbit_camera.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

constexpr double kFitMargin = 1.06;

}  // namespace

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
