#include "haptic_server/cases/phantom/analytic_body.h"

#include <algorithm>
#include <cmath>

#include "haptic_server/core/volume/surface_ramp.h"

namespace bonemill {
namespace {

// The solid is u <= 0 and v <= 0 of two surfaces that meet at a right angle.
double rightAngledEdge(double u, double v) noexcept {
    return std::hypot(std::max(u, 0.0), std::max(v, 0.0)) + std::min(std::max(u, v), 0.0);
}

// Works in the plane across the edge; by symmetry only the face at +x matters.
double wedgeDistance(double x, double z, double angle) noexcept {
    const double across = std::abs(x), s = std::sin(angle / 2), c = std::cos(angle / 2);
    const double along_face = across * s - z * c;
    return along_face < 0 ? std::hypot(across, z) : across * c + z * s;
}

}  // namespace

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

double signedDistance(const AnalyticBody& body, const Eigen::Vector3d& p_W) noexcept {
    const Eigen::Vector3d p = body.X_WB.inverse() * p_W;
    const double half = body.thickness / 2;
    switch (body.kind) {
        case BodyKind::kSlab:
            return std::abs(p.z()) - half;
        case BodyKind::kSphere:
            return p.norm() - body.radius;
        case BodyKind::kHole:
            return rightAngledEdge(body.radius - std::hypot(p.x(), p.y()), std::abs(p.z()) - half);
        case BodyKind::kWedge:
            return wedgeDistance(p.x(), p.z(), body.angle);
        case BodyKind::kThinWall:
            return rightAngledEdge(std::abs(p.x()) - half, p.z());
    }
    return 0;
}

std::vector<float> sampleBodySlice(const AnalyticBody& body, const VolumeGeometry& geometry, double full,
                                   int k) {
    std::vector<float> values;
    values.reserve(size_t(geometry.dims.x()) * size_t(geometry.dims.y()));
    for (int j = 0; j < geometry.dims.y(); ++j)
        for (int i = 0; i < geometry.dims.x(); ++i) {
            const Eigen::Vector3d p_W =
                geometry.X_WV * geometry.spacing.cwiseProduct(Eigen::Vector3d(i, j, k));
            const double share = rampShare(signedDistance(body, p_W), geometry.spacing.maxCoeff());
            values.push_back(float(std::round(full * share)));
        }
    return values;
}

VolumeGeometry centredGrid(const Eigen::Vector3i& dims, double voxel_size) {
    VolumeGeometry geometry;
    geometry.dims = dims;
    geometry.spacing.setConstant(voxel_size);
    geometry.X_WV.position = -(dims.cast<double>().array() - 1).matrix() * voxel_size / 2;
    return geometry;
}

}  // namespace bonemill
