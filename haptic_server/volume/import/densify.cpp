#include "haptic_server/volume/import/densify.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "common/config/user_error.h"
#include "haptic_server/volume/import/propose_iso.h"
#include "haptic_server/volume/import/small_pieces.h"

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
    const Eigen::Vector3i n = volume.dims();
    size_t next = 0;
    for (int k = 0; k < n.z(); ++k)
        for (int j = 0; j < n.y(); ++j)
            for (int i = 0; i < n.x(); ++i) volume.set(i, j, k, mapping.density(raw.values[next++]));
    return volume;
}

VoxelVolume densify(const RawVolume& raw, const DensityWindow& window) {
    VoxelVolume volume = densify(raw, chooseMapping(raw, window));
    removeSmallPieces(volume, window.smallest_piece_voxels);
    return volume;
}

}  // namespace bonemill
