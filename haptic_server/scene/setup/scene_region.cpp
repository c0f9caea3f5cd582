#include "haptic_server/scene/setup/scene_region.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/config/scene_geometry.h"
#include "common/config/scene_tools.h"
#include "haptic_server/scans/densify/densify.h"
#include "haptic_server/scans/densify/region.h"
#include "haptic_server/scans/find_bone/bone_pieces.h"
#include "haptic_server/scans/find_bone/propose_iso.h"
#include "haptic_server/scene/setup/refuse_field.h"

namespace bonemill {
namespace {

constexpr size_t kMaxRemarked = 4, kMaxListed = 100;

std::vector<bool> droppedOf(const LoadedScene& loaded, const BonePieces& pieces, const IndexBox& region,
                            int scan_voxels) {
    const scene::Volume& scene = loaded.scene.volume();
    const size_t count = pieces.list().size();
    std::vector<bool> is_dropped(count), touches(count, true);
    if (scene.keep_pieces() == scene::Volume::TOUCHING_REGION) {
        if (region.isEmpty())
            refuseField(loaded, "volume.keep_pieces", ": TOUCHING_REGION needs a volume.region");
        touches = pieces.touching(region);
    }
    for (size_t n = 0; n < count; ++n)
        is_dropped[n] = pieces.list()[n].voxels * uint64_t(scan_voxels) < scene.smallest_piece_voxels() ||
                        !touches[n] || (scene.keep_pieces() == scene::Volume::LARGEST_PIECE && n > 0);
    for (int n = 0; n < scene.drop_piece_size(); ++n) {
        if (scene.drop_piece(n) > count)
            refuseField(loaded, "volume.drop_piece[" + std::to_string(n) + "]",
                        ": there are only " + std::to_string(count) + " pieces");
        is_dropped[scene.drop_piece(n) - 1] = true;
    }
    return is_dropped;
}

// Those whose is_listed is true: the largest, and how many more.
std::string list(const BonePieces& pieces, const std::vector<bool>& is_dropped, bool is_listed,
                 const VolumeGeometry& geometry, const char* separator, size_t most) {
    std::string text;
    size_t listed = 0, more = 0;
    uint64_t voxels = 0;
    for (size_t n = 0; n < is_dropped.size(); ++n) {
        if (is_dropped[n] != is_listed) continue;
        if (listed == most) {
            ++more;
            voxels += pieces.list()[n].voxels;
            continue;
        }
        text += (listed++ > 0 ? separator : "") + textOf(pieces.list()[n], n + 1, geometry);
    }
    if (more > 0)
        text += separator + std::to_string(more) + " more of " + std::to_string(voxels) + " voxels in all";
    return text;
}

constexpr double kLargeBurrShare = 0.125;  // what its tick can bear (docs/measurements.md)
constexpr double kBurrShare = 0.25;  // docs/reference/volumes.md: voxels of a quarter of the burr's radius
constexpr double kAirHu = -1000, kSurelyAirHu = -500, kDensestHu = 3071;
constexpr double kProposedVoxels = 1 << 26;
constexpr double kMostVoxels = 1 << 28;
constexpr int64_t kMaxLookedAt = 1 << 28;  // for thin walls: a second
// What is only looked at needs no more voxels than this, and would not fit into memory with them.
constexpr size_t kMaxAround = size_t(1) << 28;
constexpr char kNowhere[] = " does not lie in the volume, or only its rim does";

Eigen::AlignedBox3d boxOf(const LoadedScene& loaded) {
    const scene::Volume::Region& region = loaded.scene.volume().region();
    const Eigen::AlignedBox3d box(metresOf(region.min_mm()), metresOf(region.max_mm()));
    if (!((box.max() - box.min()).minCoeff() > 0))
        refuseField(loaded, "volume.region", " is empty: each of max_mm must be greater than that of min_mm");
    return box;
}

struct BurrRadii {
    double smallest = std::numeric_limits<double>::infinity(), largest = 0;  // m
};

BurrRadii burrsOf(const scene::Scene& scene) {
    BurrRadii radii;
    for (const scene::Tool* tool : toolsOf(scene)) {
        radii.smallest = std::min(radii.smallest, tool->burr_radius_mm() * kMillimetre);
        radii.largest = std::max(radii.largest, tool->burr_radius_mm() * kMillimetre);
    }
    return radii;
}

double voxelsOf(const VolumeGeometry& geometry) {
    return geometry.dims.cast<double>().prod();
}

std::string rounded(double value) {
    std::ostringstream text;
    text.precision(3);
    text << value;
    return text.str();
}

struct VoxelChoice {
    double edge;  // m
    std::string why;
};

VoxelChoice chooseVoxel(const LoadedScene& loaded, const VolumeGeometry& scan,
                        const Eigen::AlignedBox3d& box) {
    const scene::Volume::Region& region = loaded.scene.volume().region();
    if (region.has_resample_mm()) return {region.resample_mm() * kMillimetre, "as the scene asks"};
    const BurrRadii burrs = burrsOf(loaded.scene);
    const double wanted = kBurrShare * burrs.smallest, least = kLargeBurrShare * burrs.largest;
    const double fine = std::max(wanted, least);
    const std::string why =
        wanted >= least
            ? "a quarter of the smallest burr's radius of " + rounded(burrs.smallest * kPerMillimetre) + " mm"
            : "an eighth of the largest burr's radius of " + rounded(burrs.largest * kPerMillimetre) +
                  " mm, which finer ones would cost too much time";
    const double volume = regionGeometry(scan, box, fine).dims.cast<double>().prod() * fine * fine * fine;
    const double affordable = std::cbrt(volume / kProposedVoxels);
    if (affordable <= fine) return {fine, why};
    return {affordable, "more than " + why + ", for 64 million voxels: a smaller region can be finer"};
}

// With the voxels around them, which hold a part of them: beside air a rim would become a shell of bone. Each
// voxel of the whole is `coarse`^3 of the scan.
void takeAway(const std::vector<Eigen::Vector3i>& dropped, const VoxelVolume& whole, int coarse,
              RawVolume& scan) {
    const Eigen::Vector3i& dims = scan.geometry.dims;
    for (const Eigen::Vector3i& voxel : dropped) {
        const IndexBox around{(voxel.array() - 1) * coarse, (voxel.array() + 2) * coarse - 1};
        forEachIndex(around.clamped(Eigen::Vector3i::Zero(), dims.array() - 1),
                     [&](const Eigen::Vector3i& v) {
                         const Eigen::Vector3i of_whole = v / coarse;
                         if (whole.at(of_whole.x(), of_whole.y(), of_whole.z()) < whole.iso())
                             scan.values.setToLowest(size_t(v.x()) +
                                                     size_t(dims.x()) *
                                                         (size_t(v.y()) + size_t(dims.y()) * size_t(v.z())));
                     });
    }
}

// A step makes the spline ring by a tenth: padding and metal far beyond bone would make bone of soft tissue.
ValueRange bandOf(const RawVolume& scan) {
    ValueRange band = scan.values.range();
    if (!scan.is_hounsfield && band.low > kSurelyAirHu) return band;
    band.low = std::max(band.low, kAirHu);
    band.high = std::min(band.high, kDensestHu);
    return band;
}

RawVolume resampled(const LoadedScene& loaded, const RawVolume& scan, std::vector<std::string>& remarks) {
    const Eigen::AlignedBox3d box = boxOf(loaded);
    const VoxelChoice voxel = chooseVoxel(loaded, scan.geometry, box);
    const VolumeGeometry region = regionGeometry(scan.geometry, box, voxel.edge);
    if (region.dims.minCoeff() < 2) refuseField(loaded, "volume.region", kNowhere);
    if (voxelsOf(region) > kMostVoxels)
        refuseField(loaded, "volume.region.resample_mm",
                    ": " + rounded(voxelsOf(region) / 1e6) + " million voxels are more than the " +
                        rounded(kMostVoxels / 1e6) +
                        " million that are allowed; raise it or take a smaller region");
    const double deblur_mm = loaded.scene.volume().region().deblur_mm();
    const std::string deblurred = deblur_mm > 0 ? ", a blur of " + rounded(deblur_mm) + " mm taken back" : "";
    std::ostringstream text;
    text << "region of " << edgesText(region.dims.cast<double>()) << " voxels of "
         << rounded(voxel.edge * kPerMillimetre) << " mm (" << voxel.why << "), resampled from voxels of "
         << edgesText(scan.geometry.spacing * kPerMillimetre) << " mm by cubic B-spline" << deblurred
         << "; the rest is shown, but neither felt nor milled";
    remarks.push_back(text.str());
    return resampleRegion(scan, region, bandOf(scan), deblur_mm * kMillimetre);
}

// Voxels that are N times larger leave no more than kMaxAround of them.
int coarseFactorOf(const VolumeGeometry& scan) {
    int factor = 1;
    while (scan.voxelCount() / (size_t(factor) * size_t(factor) * size_t(factor)) > kMaxAround) ++factor;
    return factor;
}

VoxelVolume wholeOf(const RawVolume& scan, int coarse, const DensityMapping& mapping,
                    std::vector<std::string>& remarks) {
    if (coarse == 1) return densifyNearBone(scan, mapping);
    std::ostringstream text;
    text << "the scan has " << rounded(voxelsOf(scan.geometry) / 1e6)
         << " million voxels: around the region it is shown, and searched for pieces, with voxels of "
         << edgesText(coarse * scan.geometry.spacing * kPerMillimetre) << " mm";
    remarks.push_back(text.str());
    return densifyNearBone(coarser(scan, coarse), mapping);
}

}  // namespace

bool choosesPieces(const scene::Scene& scene) {
    const scene::Volume& volume = scene.volume();
    return volume.smallest_piece_voxels() > 1 || volume.keep_pieces() != scene::Volume::ALL_PIECES ||
           volume.drop_piece_size() > 0;
}

void dropPieces(const LoadedScene& loaded, VoxelVolume& volume, const IndexBox& region,
                std::vector<std::string>& remarks, const DroppedVoxels& of_dropped) {
    if (!choosesPieces(loaded.scene)) return;
    const BonePieces pieces(volume);
    const std::vector<bool> is_dropped = droppedOf(loaded, pieces, region, of_dropped.scan_voxels);
    if (!std::ranges::count(is_dropped, false))
        refuseField(loaded, "volume",
                    pieces.list().empty() ? ": no voxel reaches the iso-value"
                                          : ": all pieces of bone are dropped; the largest is " +
                                                textOf(pieces.list()[0], 1, volume.geometry()));
    const std::string dropped = list(pieces, is_dropped, true, volume.geometry(), "; ", kMaxRemarked);
    remarks.push_back("kept " + list(pieces, is_dropped, false, volume.geometry(), "; ", kMaxRemarked) +
                      (dropped.empty() ? "" : "; dropped " + dropped));
    pieces.drop(volume, is_dropped, of_dropped.see);
}

std::string listPieces(const VoxelVolume& volume) {
    const BonePieces pieces(volume);
    return list(pieces, std::vector<bool>(pieces.list().size()), false, volume.geometry(), "\n  ",
                kMaxListed);
}

IndexBox usedVoxels(const LoadedScene& loaded, const VolumeGeometry& scan) {
    const Eigen::Vector3i last = scan.dims.array() - 1;
    if (!loaded.scene.volume().has_region()) return {Eigen::Vector3i::Zero(), last};
    const VolumeGeometry region = regionGeometry(scan, boxOf(loaded), scan.spacing.minCoeff());
    if (region.voxelCount() == 0) return {};
    const Eigen::Array3d low = (scan.X_WV.inverse() * region.X_WV.position).array() / scan.spacing.array();
    const Eigen::Array3d size =
        region.spacing.array() * region.dims.cast<double>().array() / scan.spacing.array();
    return {low.floor().cast<int>().max(0).matrix(),
            (low + size).ceil().cast<int>().min(last.array()).matrix()};
}

void remarkThinWalls(const LoadedScene& loaded, const RawVolume& scan, double iso_value,
                     std::vector<std::string>& remarks) {
    const IndexBox used = usedVoxels(loaded, scan.geometry);
    if (used.count() > kMaxLookedAt) return;
    const ThinWalls walls = findThinWalls(scan, used, iso_value);
    if (walls.voxels == 0) return;
    remarks.push_back(std::to_string(walls.voxels) + " voxels (" +
                      rounded(double(walls.voxels) * scan.geometry.spacing.prod() * kPerCubicMillimetre) +
                      " mm^3) below the iso-value look like walls of some " +
                      rounded(walls.median_thickness * kPerMillimetre) +
                      " mm (median), too thin for the scan's voxels: they are no bone here; a lower "
                      "volume.iso_value keeps more");
}

CutScan cutRegion(const LoadedScene& loaded, RawVolume scan, const DensityMapping& mapping,
                  std::vector<std::string>& remarks) {
    const IndexBox used = usedVoxels(loaded, scan.geometry);
    if (used.isEmpty() || (used.max - used.min).minCoeff() < 1)
        refuseField(loaded, "volume.region", kNowhere);
    const int coarse = coarseFactorOf(scan.geometry);
    VoxelVolume whole = wholeOf(scan, coarse, mapping, remarks);
    std::vector<Eigen::Vector3i> dropped;
    dropPieces(loaded, whole, {used.min / coarse, used.max / coarse}, remarks,
               {.see = [&](const Eigen::Vector3i& v) { dropped.push_back(v); },
                .scan_voxels = coarse * coarse * coarse});
    takeAway(dropped, whole, coarse, scan);
    clearFarFromBone(whole);
    RawVolume region = resampled(loaded, scan, remarks);
    const double blur = loaded.scene.volume().region().deblur_mm() * kMillimetre;
    LayersAround beyond(scan, region.geometry, bandOf(scan), blur, RegionRim::kLayers);
    const Pose X_VS = region.geometry.X_WV.inverse() * whole.geometry().X_WV;
    Eigen::AlignedBox3d bone = placesOf(boneBox(whole), whole.spacing());
    if (!bone.isEmpty()) bone = {X_VS * bone.min(), X_VS * bone.max()};  // X_VS keeps the axes' directions
    return {std::move(region), std::move(beyond), std::move(whole), X_VS, bone};
}

bool hasCoarsePieces(const VolumeGeometry& scan) {
    return coarseFactorOf(scan) > 1;
}

void removeSpecks(VoxelVolume& region, const VolumeGeometry& scan) {
    constexpr double kSpeck = 4;  // voxels of the scan
    removeSmallPieces(region, uint32_t(kSpeck * scan.spacing.prod() / region.voxelVolume()));
}

}  // namespace bonemill
