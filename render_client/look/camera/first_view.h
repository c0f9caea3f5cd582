// The camera stands at first as asked for, or else so that the bone fills the picture.
//
// The frame is W, the units are m and rad. The functions are pure and never throw; any thread may call them.
#pragma once

#include <optional>
#include <span>

#include "render_client/look/camera/orbit_camera.h"

namespace bonemill {

// This is asked of the first view; the rest is chosen.
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

}  // namespace bonemill
