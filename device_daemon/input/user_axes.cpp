#include "device_daemon/input/user_axes.h"

#include "render_client/camera/orbit_camera.h"

namespace bonemill {

Eigen::Quaterniond userAxesOf(double azimuth, double elevation, const Eigen::Vector3d& up_W,
                              const Eigen::Quaterniond& R_WD) {
    OrbitCamera camera;
    camera.setUp(up_W);
    camera.azimuth = azimuth;
    camera.elevation = elevation;
    return (R_WD.conjugate() * Eigen::Quaterniond(camera.R_WC())).normalized();
}

}  // namespace bonemill
