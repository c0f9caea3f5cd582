#include "haptic_server/lab/accuracy_report/fine_bone.h"

#include <cmath>

namespace bonemill {
namespace {

Eigen::Vector3i refinedDims(const IndexBox& box, int times) {
    return (box.max - box.min) * times + Eigen::Vector3i::Ones();
}

// Writes a row of voxels along x as numbers, interpolated between four rows.
void interpolateRow(const VoxelVolume& volume, const IndexBox& box, int j, int k, double fy, double fz,
                    std::vector<double>& row) {
    for (int i = box.min.x(); i <= box.max.x(); ++i) {
        const auto at = [&](int dj, int dk) { return double(volume.at(i, j + dj, k + dk)); };
        const double low = fy > 0 ? at(0, 0) + fy * (at(1, 0) - at(0, 0)) : at(0, 0);
        double value = low;
        if (fz > 0) {
            const double high = fy > 0 ? at(0, 1) + fy * (at(1, 1) - at(0, 1)) : at(0, 1);
            value = low + fz * (high - low);
        }
        row[size_t(i - box.min.x())] = value;
    }
}

}  // namespace

size_t refinedCount(const IndexBox& box, int times) {
    const Eigen::Vector3i dims = refinedDims(box, times);
    return size_t(dims.x()) * size_t(dims.y()) * size_t(dims.z());
}

int affordableRefinement(const IndexBox& box, int most, size_t room) {
    int times = most;
    while (times > 1 && refinedCount(box, times) > room) --times;
    return times;
}

IndexBox voxelsAround(const VoxelVolume& volume, const Eigen::AlignedBox3d& box_V, double margin) {
    const Eigen::Array3d spacing = volume.spacing().array();
    const Eigen::Array3d low = ((box_V.min().array() - margin) / spacing).floor();
    const Eigen::Array3d high = ((box_V.max().array() + margin) / spacing).ceil();
    const Eigen::Array3d dims = volume.dims().cast<double>().array();
    return {low.max(-1.0).min(dims).cast<int>().matrix(), high.max(-1.0).min(dims).cast<int>().matrix()};
}

VoxelVolume refinedPart(const VoxelVolume& volume, const IndexBox& box, int times) {
    VolumeGeometry geometry = volume.geometry();
    geometry.dims = refinedDims(box, times);
    geometry.X_WV.position = volume.geometry().X_WV * volume.spacing().cwiseProduct(box.min.cast<double>());
    geometry.spacing /= times;
    VoxelVolume fine(geometry, volume.iso());
    std::vector<double> row(size_t(box.max.x() - box.min.x() + 1));
    for (int k = 0; k < geometry.dims.z(); ++k)
        for (int j = 0; j < geometry.dims.y(); ++j) {
            interpolateRow(volume, box, box.min.y() + j / times, box.min.z() + k / times,
                           double(j % times) / times, double(k % times) / times, row);
            for (int i = 0; i < geometry.dims.x(); ++i) {
                const size_t cell = size_t(i / times);
                const double f = double(i % times) / times;
                const double value = f > 0 ? row[cell] + f * (row[cell + 1] - row[cell]) : row[cell];
                fine.set(i, j, k, Density(std::lround(value)));
            }
        }
    return fine;
}

}  // namespace bonemill
