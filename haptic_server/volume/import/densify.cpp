#include "haptic_server/volume/import/densify.h"

#include <cmath>
#include <cstdio>

#include "common/user_error.h"
#include "haptic_server/volume/import/bone_pieces.h"
#include "haptic_server/volume/import/propose_iso.h"

namespace bonemill {
namespace {

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

// Calls before_reading(k) before it reads a value of slice k.
template <class BeforeReading>
void fill(VoxelVolume& volume, const RawValues& values, const DensityMapping& mapping,
          BeforeReading&& before_reading) {
    const size_t row = size_t(volume.dims().x()), slice = row * size_t(volume.dims().y());
    values.visit([&](auto samples) {
        volume.fill([&](int i, int j, int k) {
            before_reading(k);
            return mapping.density(samples[size_t(i) + row * size_t(j) + slice * size_t(k)]);
        });
    });
}

}  // namespace

Density DensityMapping::density(double raw) const noexcept {
    const double counts = (raw - low) / (high - low) * kMaxDensity;
    if (!(counts > 0)) return 0;  // NaN too
    return counts >= kMaxDensity ? kMaxDensity : Density(std::lround(counts));
}

DensityMapping chooseMapping(const RawVolume& raw, const DensityWindow& window) {
    DensityMapping mapping;
    const ValueRange& range = raw.values.range();
    if (range.low > range.high) throw UserError("the volume holds no finite value (" + raw.description + ")");
    mapping.low = window.low.value_or(range.low);
    mapping.high = window.high.value_or(range.high);
    const std::string window_text = number(mapping.low) + " .. " + number(mapping.high);
    if (!(mapping.low < mapping.high))
        throw UserError("the density window " + window_text +
                        " is empty; window_low must be below window_high");
    const std::optional<double> known = window.iso ? window.iso : raw.surface_value;
    if (!known) mapping.proposed = proposeIso(raw);
    mapping.iso_value = known ? *known : mapping.proposed->value;
    mapping.iso = mapping.density(mapping.iso_value);
    if (mapping.iso == 0 || mapping.iso == kMaxDensity)
        throw UserError(std::string("the ") + (mapping.proposed ? "proposed " : "") + "iso-value " +
                        number(mapping.iso_value) + " is not well inside the density window " + window_text +
                        "; set iso_value, window_low and window_high in the scene");
    return mapping;
}

VoxelVolume densify(const RawVolume& raw, const DensityMapping& mapping) {
    VoxelVolume volume(raw.geometry, mapping.iso);
    fill(volume, raw.values, mapping, [](int) {});
    return volume;
}

VoxelVolume densify(RawVolume&& raw, const DensityMapping& mapping) {
    VoxelVolume volume(raw.geometry, mapping.iso);
    const size_t slice = size_t(volume.dims().x()) * size_t(volume.dims().y());
    size_t kept = 0;  // first slice that has not been given back
    fill(volume, raw.values, mapping, [&](int k) {
        // Bricks are filled layer by layer, so nobody asks again for what lies a brick below.
        for (; kept + kBrickEdge <= size_t(k); ++kept) raw.values.forget(slice * kept, slice * (kept + 1));
    });
    return volume;
}

VoxelVolume densify(const RawVolume& raw, const DensityWindow& window) {
    VoxelVolume volume = densify(raw, chooseMapping(raw, window));
    removeSmallPieces(volume, window.smallest_piece_voxels);
    return volume;
}

}  // namespace bonemill
