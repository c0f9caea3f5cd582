#include "render_client/look/camera/camera.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace bonemill {
namespace {

constexpr double kWorkingDistance =
    0.25;  // m from the objective to the focus, as ear and spine surgeons have it

constexpr double kFieldOfView = 75 * kDegree;
constexpr double kBehind = 2.8;        // burr radii from the burr's centre to the eye, along the shaft
constexpr double kBeside = 0.9;        // and across it: still inside the corridor that the burr has milled
constexpr double kTilt = 8 * kDegree;  // towards the burr
constexpr double kMinBurr = 1e-4;      // m

constexpr double kFitMargin = 1.06;

constexpr double kMaxDepthRatio = 5000;         // far over near
constexpr double kDepthStep = 1.0 / (1 << 24);  // of the depth buffer
// At the focus one step is so small a part of a pixel in a picture of N lines: the occlusion takes
// normals from differences of depth, and flat faces have stripes where steps are larger.
constexpr double kStepOfPixel = 0.01;
constexpr int kLines = 1000;
constexpr double kNearestFar = 1e-3;     // m
constexpr double kEyesApart = 1.0 / 30;  // of the distance to the focus: comfortable on a desk

Camera movedRight(Camera camera, double distance) {
    camera.eye_W += distance * camera.R_WC.col(0);
    camera.shift -= distance / camera.focus;
    return camera;
}

}  // namespace

Camera microscopeCamera(const Camera& orbit) {
    Camera camera = orbit;
    camera.eye_W = orbit.target_W() - kWorkingDistance * orbit.forward_W();
    camera.field_of_view = 2 * std::atan(orbit.halfTangent() * orbit.focus / kWorkingDistance);
    camera.focus = kWorkingDistance;
    return camera;
}

Camera endoscopeCamera(const Pose& X_WT, double burr_radius) {
    const double radius = std::max(burr_radius, kMinBurr);
    const Eigen::Matrix3d R_WT = X_WT.rotation.toRotationMatrix();
    Eigen::Matrix3d R_TC;
    R_TC.col(0) = -Eigen::Vector3d::UnitX();
    R_TC.col(1) = Eigen::Vector3d::UnitZ();
    R_TC.col(2) = Eigen::Vector3d::UnitY();
    Camera camera;
    camera.R_WC = R_WT * R_TC * Eigen::AngleAxisd(-kTilt, Eigen::Vector3d::UnitX()).toRotationMatrix();
    camera.eye_W = X_WT * Eigen::Vector3d(0, kBehind * radius, kBeside * radius);
    camera.field_of_view = kFieldOfView;
    camera.focus = kBehind * radius;
    return camera;
}

ViewWish ViewWish::orElse(const ViewWish& other) const {
    ViewWish wish = *this;
    if (!wish.target_W) wish.target_W = other.target_W;
    if (!wish.distance) wish.distance = other.distance;
    if (!wish.azimuth) wish.azimuth = other.azimuth;
    if (!wish.elevation) wish.elevation = other.elevation;
    return wish;
}

OrbitCamera firstView(const ViewWish& wish, const Eigen::Vector3d& up_W,
                      std::span<const Eigen::Vector3d> corners_W, double aspect) {
    OrbitCamera camera;
    camera.setUp(up_W);
    camera.azimuth = wish.azimuth.value_or(camera.azimuth);
    camera.elevation = wish.elevation.value_or(camera.elevation);
    camera.orbit(0, 0);  // into range
    camera.fit(corners_W, aspect);
    camera.target_W = wish.target_W.value_or(camera.target_W);
    camera.distance = wish.distance.value_or(camera.distance);
    camera.zoom(1);  // into range
    return camera;
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

Eigen::Vector3d Camera::rayThrough(int x, int y, int width, int height) const {
    const double tangent_per_pixel = halfTangent() / height;
    return R_WC * Eigen::Vector3d((2 * x + 1 - width) * tangent_per_pixel + shift,
                                  (height - 2 * y - 1) * tangent_per_pixel, -1);
}

double Camera::halfTangent() const {
    return std::tan(field_of_view / 2);
}

Eigen::Matrix4f Camera::X_CW() const {
    const Eigen::Matrix3d R_CW = R_WC.transpose();
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topLeftCorner<3, 3>() = R_CW;
    matrix.topRightCorner<3, 1>() = -R_CW * eye_W;
    return matrix.cast<float>();
}

Eigen::Matrix4f Camera::clipFromCamera(double aspect, const DepthRange& range) const {
    const double focal = 1 / halfTangent();
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
    matrix(0, 0) = focal / aspect;
    matrix(0, 2) = focal / aspect * shift;
    matrix(1, 1) = focal;
    matrix(2, 2) = -(range.far + range.near) / (range.far - range.near);
    matrix(2, 3) = -2 * range.far * range.near / (range.far - range.near);
    matrix(3, 2) = -1;
    return matrix.cast<float>();
}

DepthRange Camera::depthRange(const Eigen::Vector3d& center_W, double radius) const {
    const double depth = (center_W - eye_W).dot(forward_W());
    const double far = std::max(depth + radius, kNearestFar);
    const double resolved = kDepthStep * focus * focus / (kStepOfPixel * metresPerPixel(kLines));
    return {std::max(depth - radius, std::min(std::max(far / kMaxDepthRatio, resolved), far / 2)), far};
}

double Camera::metresPerPixel(int height) const {
    return 2 * focus * halfTangent() / height;
}

StereoPair stereoPair(const Camera& camera) {
    const double half = kEyesApart * camera.focus / 2;
    return {movedRight(camera, -half), movedRight(camera, half)};
}

}  // namespace bonemill
