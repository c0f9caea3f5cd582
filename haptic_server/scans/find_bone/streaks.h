// Measures how far the streaks of metal spoil the slices that it lies in.
//
// Streaks make soft tissue uneven: values that differ by little without metal differ by much. The measure is
// the artefact index of the literature, the standard deviation in a slice with metal over that in one
// without, made robust: of neighbours 3 mm apart that are both soft tissue (-300 .. 300 HU) the median
// difference counts, in rings of 5 mm around the metal, and the same places of the slices next to the metal
// are what it is compared with, the worse of both sides. Streaks lie in the plane of the slices (the third
// axis is across). For start-up only.
#pragma once

#include <optional>
#include <span>

#include "haptic_server/core/volume/index_box.h"
#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

struct Streaks {
    int first_slice = 0, last_slice = 0;  // with metal
    double spread = 0, usual_spread = 0;  // HU, standard deviation beside the metal, and where there is none
    double reach = 0;                     // m, in the slice, from the metal; 0: as even as other slices
    bool goes_further = false;            // than anyone looked
};

// `metal` are boxes of its pieces, the largest first; the slices of that one are looked at, with those that
// join them, and distances are from the largest 64 in there. `water` is the value of 0 HU. Nothing comes
// where there is too little soft tissue around the metal, or no slice without it.
std::optional<Streaks> measureStreaks(const RawVolume& scan, double water, std::span<const IndexBox> metal);

}  // namespace bonemill
