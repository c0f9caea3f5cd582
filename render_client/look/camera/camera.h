// It is a pin-hole camera as the renderer takes it, whatever decided where it stands.
//
// The frames are W, the world (m), and C, the camera: x right, y up, z out of the picture. They are plain
// values, for any thread, and nothing throws.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

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

}  // namespace bonemill
