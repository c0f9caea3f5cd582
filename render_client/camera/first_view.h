// Where the camera stands at first: as asked for, or else so that the bone fills the picture.
//
// Frame W, m, rad. Pure functions, any thread, never throw.
#pragma once

#include <optional>
#include <span>

#include "render_client/camera/orbit_camera.h"

namespace bonemill {

// What is asked of the first view; the rest is chosen.
struct ViewWish {
    std::optional<Eigen::Vector3d> target_W;
    std::optional<double> distance;
    std::optional<double> azimuth;
    std::optional<double> elevation;

    // This wish, and the other one where this one asks for nothing.
    ViewWish orElse(const ViewWish& other) const;
};

// up_W: as OrbitCamera::setUp(). corners_W: of the bone's box; empty: nothing is known of it. aspect: the
// picture's width over its height.
OrbitCamera firstView(const ViewWish& wish, const Eigen::Vector3d& up_W,
                      std::span<const Eigen::Vector3d> corners_W, double aspect);

}  // namespace bonemill
