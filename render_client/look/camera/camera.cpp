#include "render_client/look/camera/camera.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

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
