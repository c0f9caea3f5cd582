#include "render_client/look/camera/first_view.h"

namespace bonemill {

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

}  // namespace bonemill
