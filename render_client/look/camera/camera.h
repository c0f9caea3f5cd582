// Cameras: the pin-hole camera that the renderer takes, and what decides where it stands.
//
// The frames are W, the world (m), C, the camera: x right, y up, z out of the picture, and T, the tool.
// Angles are rad. They are plain values and pure functions, for any thread, and nothing throws.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <span>

#include "common/geometry/pose.h"
#include "common/geometry/view_axes.h"

namespace bonemill {

struct DepthRange {
    double near = 0;  // m in front of the eye
    double far = 0;
};

struct Camera {
    Eigen::Vector3d eye_W = Eigen::Vector3d::Zero();     // m
    Eigen::Matrix3d R_WC = Eigen::Matrix3d::Identity();  // columns: the camera's axes in W
    double field_of_view = 0.52;                         // rad, vertical
    double focus = 0.3;  // m in front of the eye: what is looked at; no parallax there in stereo
    double shift = 0;    // x / depth of the picture's middle: not 0 for the off-axis eyes of stereo

    Eigen::Vector3d forward_W() const { return -R_WC.col(2); }
    Eigen::Vector3d target_W() const { return eye_W + focus * forward_W(); }
    double halfTangent() const;  // of half the field of view, vertical

    Eigen::Matrix4f X_CW() const;
    Eigen::Matrix4f clipFromCamera(double aspect, const DepthRange& range) const;

    // Returns the near and far planes that hold the sphere (W, m) as well as the resolution of the depth
    // buffer allows, which has to do for what is at the focus: what is much nearer to the eye is not seen.
    DepthRange depthRange(const Eigen::Vector3d& center_W, double radius) const;

    // Returns the metres that one pixel spans at the focus, in a picture of this height (pixels).
    double metresPerPixel(int height) const;

    // Returns the way to what is seen in the middle of a pixel (y down) 1 m in front of the eye, in W.
    Eigen::Vector3d rayThrough(int x, int y, int width, int height) const;
};

// The two eyes stand beside this camera. Their screens have no parallax at its focus.
struct StereoPair {
    Camera left, right;
};
StereoPair stereoPair(const Camera& camera);

// This camera moves on a sphere around a target: it orbits, zooms, pans and fits.
// Frames and angles are those of common/geometry/view_axes.h.
class OrbitCamera {
  public:
    static constexpr double kFieldOfView = 0.52;  // rad, vertical: a moderate telephoto keeps proportions
    static constexpr double kMaxElevation = kMaxViewElevation;
    static constexpr double kMinDistance = 5e-4;   // m
    static constexpr double kMaxDistance = 100.0;  // m

    Eigen::Vector3d target_W = Eigen::Vector3d::Zero();  // m
    double distance = 0.3;                               // m, eye to target
    double azimuth = 0.61;                               // rad
    double elevation = 0.44;                             // rad

    // A null or non-finite vector means +z. What is kept has unit length.
    void setUp(const Eigen::Vector3d& up_W) { up_W_ = unitUp(up_W); }
    const Eigen::Vector3d& up_W() const { return up_W_; }

    void orbit(double delta_azimuth, double delta_elevation);
    // A factor below 1 comes nearer.
    void zoom(double factor);
    // The picture follows by these fractions of its height; right and up are positive.
    void pan(double right, double up);

    Eigen::Vector3d eye_W() const { return target_W + distance * towardsEye_W(); }
    Eigen::Vector3d towardsEye_W() const { return R_WC().col(2); }  // of unit length
    // The columns are the camera's axes in W.
    Eigen::Matrix3d R_WC() const { return viewAxes(azimuth, elevation, up_W_); }
    Camera view() const;

    // Centres on the box and goes as near as every corner (m) allows with a margin. The angles stay.
    void fit(std::span<const Eigen::Vector3d> corners_W, double aspect);

  private:
    Eigen::Vector3d up_W_ = Eigen::Vector3d::UnitZ();
};

// This is asked of the first view; the rest is chosen so that the bone fills the picture.
struct ViewWish {
    std::optional<Eigen::Vector3d> target_W;
    std::optional<double> distance;
    std::optional<double> azimuth;
    std::optional<double> elevation;

    // Returns this wish, and what the other one asks for where this one asks for nothing.
    ViewWish orElse(const ViewWish& other) const;
};

// up_W is taken as by OrbitCamera::setUp(). corners_W are those of the bone's box; there are none while
// nothing is known of it. aspect is the picture's width over its height.
OrbitCamera firstView(const ViewWish& wish, const Eigen::Vector3d& up_W,
                      std::span<const Eigen::Vector3d> corners_W, double aspect);

// This camera rides on the tool: beside the shaft it looks past the burr along the tool's axis (-y of T).
// The picture's up is T's +z; the burr stands below the middle of the picture.
Camera endoscopeCamera(const Pose& X_WT, double burr_radius);

// An operating microscope looks at the orbit's target from its side, but from its own working distance: what
// the orbit does by coming nearer, it does by magnifying. The picture has the same height at the target as
// the orbit's, so that pixels span the same lengths there.
Camera microscopeCamera(const Camera& orbit);

}  // namespace bonemill
