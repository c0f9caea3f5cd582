// Proposes the raw value of the bone surface when the scene gives none, says how sure it is,
// and finds the walls that the scan's voxels have blurred to below it, so that they do not vanish without a
// word.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "haptic_server/core/volume/index_box.h"
#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

enum class IsoDoubt : uint8_t { kLittle, kSome, kLarge };

struct IsoProposal {
    double value = 0;
    IsoDoubt doubt = IsoDoubt::kLarge;
    std::optional<double> runner_up = {};
    std::string why = {};   // the rule that gave it
    double bone_share = 0;  // of the finite values that are not below
};

// The value comes from the histogram of the finite values; rules and measured table are in
// docs/reference/volumes.md.
//   1. On the Hounsfield scale (is_hounsfield, or shifted by +1024 as some exports are) it is half-way
//      between the peak of soft tissue and the median of what is clearly bone, kept within 200 .. 300 HU.
//   2. On another scale with one material above air, and a thin tail far above that, the material is taken
//   for soft
//      tissue and the tail for bone.
//   3. Else (industrial CT, dry bone, phantoms) it is half-way between the background (most voxels) and the
//   next
//      denser material that is no mere edge or cavity.
//   4. Where only one material stands out it is Otsu's threshold.
// It is deterministic. It allocates, so it is not RT-safe. Throws UserError when the values are all alike or
// none is finite.
IsoProposal proposeIso(const RawVolume& raw);

// The value of 0 HU; none if the values are no Hounsfield units, shifted by 1024 or not.
std::optional<double> waterValue(const RawVolume& raw);

// For people; the proposal with what looks odd about it.
const char* wordOf(IsoDoubt doubt);
std::string textOf(const IsoProposal& proposed);

// A voxel below the iso-value is of a thin wall if along one of the grid's axes it is the highest of five,
// and stands above the higher of both ends by at least half of what lies between that end and the iso-value.
// The wall's thickness is what the five hold above that end, over what bone holds above it (partial volume:
// blur keeps the sum), along the axis where it is thinnest. A rough figure: it knows no slant, and bone for
// the mean of what is above the iso-value.
struct ThinWalls {
    uint64_t voxels = 0;
    double median_thickness = 0;  // m; 0 without any
};

// Looks at the voxels of a box within the scan. Start-up only; allocates four bytes per voxel found.
ThinWalls findThinWalls(const RawVolume& scan, const IndexBox& within, double iso_value);

}  // namespace bonemill
