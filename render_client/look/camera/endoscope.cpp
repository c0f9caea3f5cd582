#include "render_client/look/camera/endoscope.h"

#include <algorithm>

#include "common/base/units.h"

namespace bonemill {
namespace {

constexpr double kFieldOfView = 75 * kDegree;
constexpr double kBehind = 2.8;        // burr radii from the burr's centre to the eye, along the shaft
constexpr double kBeside = 0.9;        // and across it: still inside the corridor that the burr has milled
constexpr double kTilt = 8 * kDegree;  // towards the burr
constexpr double kMinBurr = 1e-4;      // m

}  // namespace

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

}  // namespace bonemill
