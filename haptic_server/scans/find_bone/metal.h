// Finds metal in a scan: fillings, crowns, screws, clips, and the streaks around it.
//
// Metal is what reaches 3050 HU: enamel ends at some 3000, and most scanners at 3071. Values of that height
// that noise has made of dense enamel are none: metal is solid, or stands out of what is around it. For
// start-up only: it allocates 8 bytes per voxel of that height, and does not look at the voxels when the scan
// has none.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "haptic_server/core/volume/index_box.h"
#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// How far the streaks of metal spoil the slices that it lies in. They make soft tissue uneven: values that
// differ by little without metal differ by much. The measure is the artefact index of the literature, the
// standard deviation in a slice with metal over that in one without, made robust: of neighbours 3 mm apart
// that are both soft tissue (-300 .. 300 HU) the median difference counts, in rings of 5 mm around the metal,
// and the same places of the slices next to the metal are what it is compared with, the worse of both sides.
// Streaks lie in the plane of the slices (the third axis is across).
struct Streaks {
    int first_slice = 0, last_slice = 0;  // with metal
    double spread = 0, usual_spread = 0;  // HU, standard deviation beside the metal, and where there is none
    double reach = 0;                     // m, in the slice, from the metal; 0: as even as other slices
    bool goes_further = false;            // than anyone looked
};

inline constexpr double kMetalHu = 3050;

// What is connected through voxel faces.
struct MetalPiece {
    uint64_t voxels = 0;  // as the scan shows it: blurred, and some voxels larger than it is
    IndexBox box;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();  // mean of its voxels' indices
    Eigen::Vector3i first = Eigen::Vector3i::Zero();   // one of its voxels
};

struct Metal {
    std::vector<MetalPiece> pieces;       // the largest comes first
    double water = 0, highest = 0;        // the value of 0 HU; the highest of all, HU
    bool is_clipped = false;              // the scanner knows no higher value than the highest
    std::optional<Streaks> streaks = {};  // of the slices of the largest piece; none: nothing to see them in
    bool is_scale_sure = true;            // not shifted: then it is a guess that they are Hounsfield units
};

// Without pieces where there is none, and where the values are no Hounsfield units (8 bit, industrial CT):
// then nothing tells metal from enamel.
Metal findMetal(const RawVolume& scan);

// For people: how much, where, where values end, how far the streaks go. Empty without metal.
std::string textOf(const Metal& metal, const VolumeGeometry& geometry);

}  // namespace bonemill
