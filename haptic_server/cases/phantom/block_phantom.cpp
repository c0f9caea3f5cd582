#include "haptic_server/cases/phantom/block_phantom.h"

#include <algorithm>
#include <cmath>

namespace bonemill {

VolumeGeometry BlockPhantom::grid() const {
    VolumeGeometry geometry;
    const Eigen::Vector3d low(-size.x() / 2 - margin, -size.y() / 2 - margin, -size.z() - margin);
    const Eigen::Vector3d high(size.x() / 2 + margin, size.y() / 2 + margin, margin);
    geometry.spacing.setConstant(voxel);
    geometry.dims = ((high - low) / voxel).array().ceil().cast<int>() + 1;
    const Eigen::Vector3d excess =
        geometry.spacing.cwiseProduct((geometry.dims.array() - 1).cast<double>().matrix()) - (high - low);
    geometry.X_WV.position = low - Eigen::Vector3d(excess.x() / 2, excess.y() / 2, excess.z());
    return geometry;
}

double BlockPhantom::signedDistance(const Eigen::Vector3d& p_W) const noexcept {
    const Eigen::Vector3d centre(0, 0, -size.z() / 2);
    const Eigen::Vector3d beyond = (p_W - centre).cwiseAbs() - size / 2;
    return beyond.cwiseMax(0).norm() + std::min(beyond.maxCoeff(), 0.0);
}

// This is the depth below what the layers follow.
double BlockPhantom::depth(const Eigen::Vector3d& p_W) const noexcept {
    return is_shell ? -signedDistance(p_W) : -p_W.z();
}

double BlockPhantom::hu(const Eigen::Vector3d& p_W) const noexcept {
    const auto share = [this](double distance) { return std::clamp(0.5 - distance / (2 * voxel), 0.0, 1.0); };
    const double at = depth(p_W);
    double inside = layers.front().hu, boundary = 0;
    for (size_t n = 1; n < layers.size(); ++n) {
        boundary += layers[n - 1].thickness;
        inside += share(boundary - at) * (layers[n].hu - layers[n - 1].hu);
    }
    return air_hu + share(signedDistance(p_W)) * (inside - air_hu);
}

uint8_t BlockPhantom::label(const Eigen::Vector3d& p_W) const noexcept {
    if (signedDistance(p_W) > 0) return 0;
    const double at = depth(p_W);
    double boundary = 0;
    for (size_t n = 0; n + 1 < layers.size(); ++n) {
        boundary += layers[n].thickness;
        if (at < boundary) return uint8_t(n + 1);
    }
    return uint8_t(layers.size());
}

}  // namespace bonemill
