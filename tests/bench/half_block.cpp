#include "tests/bench/half_block.h"

#include <algorithm>
#include <cmath>

namespace bonemill::bench {
namespace {

constexpr double kFaceOffset = 0.3;   // voxels: not in step with the grid
constexpr double kMaxHeading = 1.05;  // rad to either side
constexpr double kWindingTime = 1.0;  // s

double faceHeight(int edge) {
    return edge / 2 + kFaceOffset;  // voxels
}

}  // namespace

VoxelVolume halfBlock(int edge, double spacing) {
    VolumeGeometry geometry;
    geometry.dims = Eigen::Vector3i::Constant(edge);
    geometry.spacing = Eigen::Vector3d::Constant(spacing);
    VoxelVolume volume(geometry, kMaxDensity / 2);
    volume.fill([&](int, int, int k) {
        const double density = (0.5 + faceHeight(edge) - k) * kMaxDensity;
        return Density(std::clamp<double>(density, 0, kMaxDensity));
    });
    return volume;
}

Eigen::Vector3d middleOfFace(const VoxelVolume& volume) {
    const int edge = volume.dims().z();
    return volume.spacing().cwiseProduct(Eigen::Vector3d(edge / 2.0, edge / 2.0, faceHeight(edge)));
}

std::vector<DeviceInput> weave(const VoxelVolume& volume, const WeaveConfig& config) {
    const Pose& X_WV = volume.geometry().X_WV;
    const Eigen::Quaterniond upright(M_SQRT1_2, M_SQRT1_2, 0, 0);  // the shaft along V's +z
    Eigen::Vector3d p_VT =
        middleOfFace(volume) + Eigen::Vector3d(0, 0, config.burr_radius + config.clearance);
    const double descent = (config.clearance + config.depth) / config.approach_ticks;
    std::vector<DeviceInput> inputs(size_t(config.ticks), DeviceInput{});
    for (int n = 0; n < config.ticks; ++n) {
        if (n < config.approach_ticks) {
            p_VT.z() -= descent;
        } else {
            const double t = (n - config.approach_ticks) * config.dt;
            const double heading = kMaxHeading * std::sin(2 * M_PI * t / kWindingTime);
            p_VT += config.speed * config.dt * Eigen::Vector3d(std::cos(heading), std::sin(heading), 0);
        }
        DeviceInput& input = inputs[size_t(n)];
        input.X_WT_device = X_WV * Pose{p_VT, upright};
        input.buttons = config.mills ? uint32_t(kButtonRemove) : 0;
        input.t_s = n * config.dt;
    }
    return inputs;
}

}  // namespace bonemill::bench
