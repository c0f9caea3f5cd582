// Proposes the raw value of the bone surface when the scene gives none.
#pragma once

#include "haptic_server/volume/raw_volume.h"

namespace bonemill {

// The value comes from the histogram of the finite values; rule and measured table are in docs/volumes.md.
//   1. On the Hounsfield scale (is_hounsfield, or shifted by +1024 as some exports are) it is half-way
//      between the peak of soft tissue and the median of what is clearly bone, kept within 200 .. 300 HU.
//   2. Without soft tissue, or on another scale (industrial CT, phantoms), it is half-way between the
//      background (most voxels) and the next denser material that is no mere edge or cavity.
//   3. Where only one material stands out it is Otsu's threshold.
// It is deterministic. It allocates, so it is not RT-safe. Throws UserError when the values are all alike or
// none is finite.
double proposeIsoValue(const RawVolume& raw);

}  // namespace bonemill
