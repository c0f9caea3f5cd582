#include "haptic_server/scene/setup/scanned_bone.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <utility>

#include "common/rt/clock.h"
#include "haptic_server/core/volume/material_properties.h"
#include "haptic_server/core/volume/raw_volume.h"
#include "haptic_server/core/volume/voxel_volume.h"
#include "haptic_server/scans/confined/free_memory.h"
#include "haptic_server/scans/confined/import_limits.h"
#include "haptic_server/scans/densify/densify.h"
#include "haptic_server/scans/densify/voxel_materials.h"
#include "haptic_server/scans/find_bone/metal.h"
#include "haptic_server/scans/import/import_volume.h"
#include "haptic_server/scene/setup/refuse_field.h"
#include "haptic_server/scene/setup/scene_region.h"
#include "haptic_server/scene/setup/scene_shapes.h"

namespace bonemill {
namespace {

constexpr double kEndOfBoneHu = 3071, kStretched = 1.5;
constexpr double kSlack = 1e-6;  // voxels

bool meet(const IndexBox& a, const IndexBox& b) {
    return ((a.min.array() <= b.max.array()) && (b.min.array() <= a.max.array())).all();
}

// What the streaks of a piece may spoil: they lie in its slices.
IndexBox reachOf(const MetalPiece& piece, const Streaks& streaks, const Eigen::Vector3d& spacing) {
    IndexBox box = piece.box;
    for (int axis = 0; axis < 2; ++axis) {
        const int steps = int(std::ceil(streaks.reach / spacing[axis]));
        box.min[axis] -= steps;
        box.max[axis] += steps;
    }
    return box;
}

bool isSpoilt(const Metal& metal, const IndexBox& used, const Eigen::Vector3d& spacing) {
    if (!metal.streaks || metal.streaks->reach == 0) return false;
    return std::ranges::any_of(metal.pieces, [&](const MetalPiece& piece) {
        return meet(reachOf(piece, *metal.streaks, spacing), used);
    });
}

// Says what metal there is in the scan, and warns where it spoils the bone that is milled. `bone` is that of
// the whole scan, without the pieces that the scene drops; its voxels may be larger than
// the scan's. `used` are the voxels of the scan that are milled.
void remarkMetal(const LoadedScene& loaded, const Metal& metal, const VolumeGeometry& scan,
                 const VoxelVolume& bone, const IndexBox& used, std::vector<std::string>& remarks,
                 std::vector<std::string>& warnings) {
    if (metal.pieces.empty()) return;
    remarks.push_back(textOf(metal, scan));
    const scene::Volume& volume = loaded.scene.volume();
    const auto isMilled = [&](const MetalPiece& piece) {
        const Eigen::Array3d place =
            piece.first.cast<double>().array() * scan.spacing.array() / bone.spacing().array();
        const Eigen::Vector3i v = (place + kSlack).cast<int>().min(bone.dims().array() - 1).matrix();
        return meet(piece.box, used) && bone.at(v.x(), v.y(), v.z()) >= bone.iso();
    };
    if (std::ranges::any_of(metal.pieces, isMilled))
        warnings.push_back(
            std::string("metal would be milled as if it were bone; ") +
            (volume.has_region() ? "choose another volume.region" : "choose a volume.region without it") +
            ", or leave it out (volume.drop_piece) where it is a piece of its own");
    if (isSpoilt(metal, used, scan.spacing))
        warnings.push_back(
            "streaks of metal cross what is milled: they make bone of tissue and gaps in bone; choose a "
            "volume.region in other slices, or further from it");
    if (!volume.has_window_high() && metal.highest > kStretched * kEndOfBoneHu)
        warnings.push_back("metal stretches the scale of densities to " + std::to_string(int(metal.highest)) +
                           " HU; volume.window_high: " + std::to_string(int(kEndOfBoneHu + metal.water)) +
                           " ends it above all bone");
}

using IsOfMaterial = std::vector<bool>;  // by MaterialId

bool isAskedFor(const scene::Task::Zone& zone) {
    return zone.role() == scene::Task::PROTECTED || zone.role() == scene::Task::TARGET;
}

void addMaterialsOf(const scene::Scene& scene, const scene::Task::Zone& zone, IsOfMaterial& is_kept) {
    for (int n = 0; n < scene.material_size(); ++n)
        if (std::ranges::count(zone.material(), scene.material(n).name()) > 0) is_kept[size_t(n) + 1] = true;
}

IsOfMaterial protectedOf(const scene::Scene& scene) {
    IsOfMaterial is_kept(size_t(scene.material_size()) + 1);
    for (int n = 0; n < scene.material_size(); ++n) is_kept[size_t(n) + 1] = scene.material(n).is_protected();
    return is_kept;
}

// Which voxels a scene asks about, whatever they are made of: its protected structures and its targets. Is
// the voxel with this index (x fastest) of a protected material, or of a protected or target zone? It is
// empty where none can be. `ids` has one of each voxel, or none if the scene has no materials, and must
// outlive what is returned. Throws UserError for a zone whose shape is no solid.
std::function<bool(size_t)> keptTissueOf(const LoadedScene& loaded, std::span<const MaterialId> ids,
                                         const VolumeGeometry& geometry) {
    const scene::Scene& scene = loaded.scene;
    IsOfMaterial is_kept = protectedOf(scene);
    std::vector<uint8_t> marks;  // of the zones with shapes; empty: there is none
    for (int n = 0; n < scene.assessment().zone_size(); ++n) {
        const scene::Task::Zone& zone = scene.assessment().zone(n);
        if (!isAskedFor(zone)) continue;
        if (zone.shape_size() == 0) {
            addMaterialsOf(scene, zone, is_kept);
            continue;
        }
        const auto inside =
            voxelsInside(loaded, zone.shape(), geometry, "assessment.zone[" + std::to_string(n) + "]");
        marks.resize(inside.size());
        std::ranges::transform(inside, marks, marks.begin(), std::bit_or<>());
    }
    const bool has_materials = !ids.empty() && std::ranges::count(is_kept, true) > 0;
    if (!has_materials && marks.empty()) return {};
    return [=, is_kept = std::move(is_kept), marks = std::move(marks)](size_t at) {
        return (has_materials && is_kept[ids[at]]) || (!marks.empty() && marks[at]);
    };
}

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
    const uint64_t needed = bone + bone / 2;
    const FreeMemory free = freeMemory();
    if (free.holds(needed)) return;
    refuseField(loaded, "volume",
                ": all of this scan is more than can be milled here: its bone takes " +
                    std::to_string(bone >> 20) + " MiB, a session needs " + std::to_string(needed >> 20) +
                    " MiB more, and " + free.text() + "; name the part that is milled in volume.region");
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
    remarkMetal(loaded, scan.metal, whole, cut.whole, scan.used, scan.remarks, scan.warnings);
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
    RegionRim rim(volume, [&](const Eigen::Vector3i& v) { return scan.mapping.density(cut.beyond.at(v)); });
    return {std::move(volume),
            scan.mapping,
            std::move(materials),
            std::move(inner),
            std::make_shared<const Surroundings>(
                Surroundings{std::move(cut.whole), cut.X_VS, cut.bone, std::move(rim)}),
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
