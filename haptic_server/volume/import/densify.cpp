#include "haptic_server/volume/import/densify.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "common/config/user_error.h"
#include "haptic_server/volume/import/propose_iso.h"

namespace bonemill {
namespace {

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

std::pair<double, double> finiteRange(const RawVolume& raw) {
    float low = std::numeric_limits<float>::infinity(), high = -low;
    for (const float v : raw.values) {
        if (!std::isfinite(v)) continue;
        low = std::min(low, v);
        high = std::max(high, v);
    }
    if (low > high) throw UserError("the volume holds no finite value (" + raw.description + ")");
    return {low, high};
}

}  // namespace

Density DensityMapping::density(double raw) const noexcept {
    const double counts = (raw - low) / (high - low) * kMaxDensity;
    if (!(counts > 0)) return 0;  // NaN too
    return counts >= kMaxDensity ? kMaxDensity : Density(std::lround(counts));
}

DensityMapping chooseMapping(const RawVolume& raw, const DensityWindow& window) {
    DensityMapping mapping;
    const auto [lowest, highest] = finiteRange(raw);
    mapping.low = window.low.value_or(lowest);
    mapping.high = window.high.value_or(highest);
    const std::string window_text = number(mapping.low) + " .. " + number(mapping.high);
    if (!(mapping.low < mapping.high))
        throw UserError("the density window " + window_text +
                        " is empty; window_low must be below window_high");
    mapping.is_iso_proposed = !window.iso;
    mapping.iso_value = window.iso ? *window.iso : proposeIsoValue(raw);
    mapping.iso = mapping.density(mapping.iso_value);
    if (mapping.iso == 0 || mapping.iso == kMaxDensity)
        throw UserError(std::string("the ") + (mapping.is_iso_proposed ? "proposed " : "") + "iso-value " +
                        number(mapping.iso_value) + " is not inside the density window " + window_text +
                        "; set iso_value, window_low and window_high in the scene");
    return mapping;
}

VoxelVolume densify(const RawVolume& raw, const DensityMapping& mapping) {
    VoxelVolume volume(raw.geometry, mapping.iso);
    const size_t row = size_t(volume.dims().x()), slice = row * size_t(volume.dims().y());
    volume.fill([&](int i, int j, int k) {
        return mapping.density(raw.values[size_t(i) + row * size_t(j) + slice * size_t(k)]);
    });
    return volume;
}

VoxelVolume densify(const RawVolume& raw, const DensityWindow& window) {
    VoxelVolume volume = densify(raw, chooseMapping(raw, window));
    removeSmallPieces(volume, window.smallest_piece_voxels);
    return volume;
}

PieceCount removeSmallPieces(VoxelVolume& volume, uint32_t smallest_piece_voxels) {
    PieceCount count;
    if (smallest_piece_voxels <= 1) return count;
    const Eigen::Vector3i n = volume.dims();
    const Density iso = volume.iso();
    const ptrdiff_t stride_y = n.x() + 2, stride_z = stride_y * (n.y() + 2);
    const ptrdiff_t steps[6] = {1, -1, stride_y, -stride_y, stride_z, -stride_z};
    const auto index = [&](size_t at) {
        return Eigen::Vector3i(int(at % size_t(stride_y)) - 1,
                               int(at % size_t(stride_z) / size_t(stride_y)) - 1,
                               int(at / size_t(stride_z)) - 1);
    };
    const auto density = [&](size_t at) {
        const Eigen::Vector3i v = index(at);
        return volume.at(v.x(), v.y(), v.z());
    };
    // The border of air stops the flood, so no index has to be checked.
    std::vector<bool> seen(size_t(stride_z) * size_t(n.z() + 2));
    std::vector<size_t> piece;
    for (int k = 0; k < n.z(); ++k)
        for (int j = 0; j < n.y(); ++j)
            for (int i = 0; i < n.x(); ++i) {
                const size_t seed = size_t(i + 1 + stride_y * (j + 1) + stride_z * (k + 1));
                if (seen[seed] || density(seed) < iso) continue;
                piece.assign(1, seed);
                seen[seed] = true;
                for (size_t next = 0; next < piece.size(); ++next)
                    for (const ptrdiff_t step : steps) {
                        const size_t neighbour = size_t(ptrdiff_t(piece[next]) + step);
                        if (seen[neighbour] || density(neighbour) < iso) continue;
                        seen[neighbour] = true;
                        piece.push_back(neighbour);
                    }
                if (piece.size() >= smallest_piece_voxels) {
                    ++count.pieces_kept;
                    continue;
                }
                ++count.pieces_removed;
                count.voxels_removed += piece.size();
                for (const size_t voxel : piece) {
                    const Eigen::Vector3i v = index(voxel);
                    volume.set(v.x(), v.y(), v.z(), Density(iso - 1));
                }
            }
    return count;
}

}  // namespace bonemill
