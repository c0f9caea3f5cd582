#include "haptic_server/scene/setup/scanned_bone.h"

#include <spdlog/spdlog.h>

#include <utility>

#include "common/rt/clock.h"
#include "haptic_server/scans/confined/import_limits.h"
#include "haptic_server/scans/densify/densify.h"
#include "haptic_server/scans/densify/voxel_materials.h"
#include "haptic_server/scans/import/import_volume.h"
#include "haptic_server/scene/setup/kept_tissue.h"
#include "haptic_server/scene/setup/refuse_field.h"
#include "haptic_server/scene/setup/scene_metal.h"
#include "haptic_server/scene/setup/scene_pieces.h"
#include "haptic_server/scene/setup/scene_region.h"

namespace bonemill {
namespace {

constexpr int64_t kLongWithoutAWordNs = 2 * kNsPerSecond;

DensityWindow windowOf(const scene::Volume& volume) {
    DensityWindow window;
    if (volume.has_window_low()) window.low = volume.window_low();
    if (volume.has_window_high()) window.high = volume.window_high();
    if (volume.has_iso_value()) window.iso = volume.iso_value();
    return window;
}

ImportOptions optionsOf(const scene::Volume& volume) {
    ImportOptions options{volume.series_uid(), volume.acquisition()};
    if (volume.has_surface_voxel_mm()) options.surface_voxel_mm = volume.surface_voxel_mm();
    options.surface_value = volume.surface_value();
    if (volume.has_spacing_mm()) {
        const scene::Vec3& mm = volume.spacing_mm();
        options.spacing_mm = Eigen::Vector3d(mm.x(), mm.y(), mm.z());
    }
    return options;
}

struct Scan {
    RawVolume raw;
    DensityMapping mapping;
    Metal metal;
    IndexBox used;  // voxels that are milled
    std::vector<std::string> remarks, warnings;
};

std::vector<uint64_t> dimsOf(const VolumeGeometry& geometry) {
    const auto dims = geometry.dims.cast<uint64_t>();
    return {dims.x(), dims.y(), dims.z()};
}

// A session keeps the bone as it was beside the bone as it is, and its surface.
void requireMemory(const LoadedScene& loaded, const VoxelVolume& volume) {
    const uint64_t bone = volume.bricks().ownCount() * kBrickSize * sizeof(Density);
    const uint64_t needed = bone + bone / 2, available = availableMemory();
    if (available == 0 || needed <= available) return;
    refuseField(loaded, "volume",
                ": all of this scan is more than can be milled here: its bone takes " +
                    std::to_string(bone >> 20) + " MiB, a session needs " + std::to_string(needed >> 20) +
                    " MiB more, and only " + std::to_string(available >> 20) +
                    " MiB of memory are free; name the part that is milled in volume.region");
}

ScannedBone wholeBone(const LoadedScene& loaded, Scan scan) {
    const VolumeGeometry whole = scan.raw.geometry;
    const bool lacks_axes = scan.raw.lacks_patient_axes;
    checkAllCanBeBone(dimsOf(whole), loaded.scene.volume().path());
    ScannedMaterials materials = scannedMaterialsOf(loaded, scan.raw, scan.remarks);
    const auto is_kept = keptTissueOf(loaded, materials.ids, scan.raw.geometry);
    VoxelVolume volume = densifyNearBone(std::move(scan.raw), scan.mapping, is_kept);
    dropPieces(loaded, volume, {}, scan.remarks);
    remarkMetal(loaded, scan.metal, whole, volume, scan.used, scan.remarks, scan.warnings);
    clearFarFromBone(volume, is_kept);
    requireMemory(loaded, volume);
    return {std::move(volume), scan.mapping, std::move(materials),    {},
            nullptr,           lacks_axes,   std::move(scan.remarks), std::move(scan.warnings)};
}

ScannedBone boneOfRegion(const LoadedScene& loaded, Scan scan) {
    const VolumeGeometry whole = scan.raw.geometry;
    CutScan cut = cutRegion(loaded, std::move(scan.raw), scan.mapping, scan.remarks);
    remarkMetal(loaded, scan.metal, whole, cut.surroundings.volume, scan.used, scan.remarks, scan.warnings);
    const bool lacks_axes = cut.region.lacks_patient_axes;
    const double iso = scan.mapping.iso_value;
    RawVolume at_surface{.geometry = cut.region.geometry, .values = {}, .description = {}};
    RawValues inner;
    if (wantsProperties(loaded.scene)) {
        inner = innerValues(cut.region, iso, whole.spacing);
        at_surface.values = surfaceValues(cut.region, inner, iso, whole.spacing);
    }
    ScannedMaterials materials = scannedMaterialsOf(loaded, at_surface, scan.remarks);
    const auto is_kept = keptTissueOf(loaded, materials.ids, at_surface.geometry);
    VoxelVolume volume = densifyNearBone(std::move(cut.region), scan.mapping, is_kept);
    removeSpecks(volume, whole);
    clearFarFromBone(volume, is_kept);
    return {std::move(volume),
            scan.mapping,
            std::move(materials),
            std::move(inner),
            std::make_shared<const Surroundings>(std::move(cut.surroundings)),
            lacks_axes,
            std::move(scan.remarks),
            std::move(scan.warnings)};
}

}  // namespace

ScannedBone readBone(const LoadedScene& loaded) {
    const scene::Volume& scene = loaded.scene.volume();
    const int64_t start_ns = monotonicNowNs();
    Scan scan{importVolume(resolvePath(loaded, scene.path()), optionsOf(scene)), {}, {}, {}, {}, {}};
    scan.remarks.push_back(scan.raw.description);
    if (monotonicNowNs() - start_ns > kLongWithoutAWordNs)
        spdlog::info("{} is read; now its bone is made", scene.path());
    scan.mapping = chooseMapping(scan.raw, windowOf(scene));
    if (scan.mapping.proposed)
        scan.remarks.push_back("no volume.iso_value in the scene: " + textOf(*scan.mapping.proposed));
    scan.metal = findMetal(scan.raw);
    scan.used = usedVoxels(loaded, scan.raw.geometry);
    remarkThinWalls(loaded, scan.raw, scan.mapping.iso_value, scan.remarks);
    return scene.has_region() ? boneOfRegion(loaded, std::move(scan)) : wholeBone(loaded, std::move(scan));
}

}  // namespace bonemill
