// Scans of fields that are known everywhere, on any grid.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "haptic_server/core/volume/index_box.h"
#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

inline RawVolume scanOf(const VolumeGeometry& geometry,
                        const std::function<double(const Eigen::Vector3d& p_W)>& value) {
    RawVolume scan;
    scan.geometry = geometry;
    std::vector<float> values;
    forEachIndex({Eigen::Vector3i::Zero(), geometry.dims.array() - 1}, [&](const Eigen::Vector3i& v) {
        values.push_back(
            float(value(geometry.X_WV * Eigen::Vector3d(geometry.spacing.cwiseProduct(v.cast<double>())))));
    });
    scan.values.append(std::span<const float>(values));
    return scan;
}

inline size_t indexOf(const VolumeGeometry& geometry, const Eigen::Vector3i& v) {
    return size_t(v.x()) +
           size_t(geometry.dims.x()) * (size_t(v.y()) + size_t(geometry.dims.y()) * size_t(v.z()));
}

inline Eigen::Vector3d placeOfVoxel(const VolumeGeometry& geometry, const Eigen::Vector3i& v) {
    return geometry.X_WV * Eigen::Vector3d(geometry.spacing.cwiseProduct(v.cast<double>()));
}

}  // namespace bonemill
