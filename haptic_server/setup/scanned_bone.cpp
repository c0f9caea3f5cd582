#include "haptic_server/setup/scanned_bone.h"

#include <utility>

#include "haptic_server/setup/scene_materials.h"
#include "haptic_server/setup/scene_pieces.h"
#include "haptic_server/setup/scene_region.h"
#include "haptic_server/volume/import/far_air.h"
#include "haptic_server/volume/import/import_volume.h"

namespace bonemill {
namespace {

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
    std::vector<std::string> remarks;
};

ScannedBone wholeBone(const LoadedScene& loaded, Scan scan) {
    const bool lacks_axes = scan.raw.lacks_patient_axes;
    std::vector<MaterialId> ids = materialIdsOf(loaded, scan.raw, scan.remarks);
    VoxelVolume volume = densifyNearBone(std::move(scan.raw), scan.mapping);
    dropPieces(loaded, volume, {}, scan.remarks);
    clearFarFromBone(volume);
    return {std::move(volume), scan.mapping, std::move(ids), nullptr, lacks_axes, std::move(scan.remarks)};
}

ScannedBone boneOfRegion(const LoadedScene& loaded, Scan scan) {
    const VolumeGeometry whole = scan.raw.geometry;
    CutScan cut = cutRegion(loaded, std::move(scan.raw), scan.mapping, scan.remarks);
    const bool lacks_axes = cut.region.lacks_patient_axes;
    std::vector<MaterialId> ids = materialIdsOf(loaded, cut.region, scan.remarks);
    VoxelVolume volume = densifyNearBone(std::move(cut.region), scan.mapping);
    removeSpecks(volume, whole);
    clearFarFromBone(volume);
    return {std::move(volume), scan.mapping,
            std::move(ids),    std::make_shared<const Surroundings>(std::move(cut.surroundings)),
            lacks_axes,        std::move(scan.remarks)};
}

}  // namespace

ScannedBone readBone(const LoadedScene& loaded) {
    const scene::Volume& scene = loaded.scene.volume();
    Scan scan{importVolume(resolvePath(loaded, scene.path()), optionsOf(scene)), {}, {}};
    scan.remarks.push_back(scan.raw.description);
    scan.mapping = chooseMapping(scan.raw, windowOf(scene));
    if (scan.mapping.proposed)
        scan.remarks.push_back("no volume.iso_value in the scene: " + textOf(*scan.mapping.proposed));
    remarkThinWalls(loaded, scan.raw, scan.mapping.iso_value, scan.remarks);
    return scene.has_region() ? boneOfRegion(loaded, std::move(scan)) : wholeBone(loaded, std::move(scan));
}

}  // namespace bonemill
