// Labels structures that a mastoidectomy must spare, for the left ear of the CT head Cranium.inv3 (Debian
// package invesalius-examples): sigmoid sinus, facial nerve, dura above the tegmen.
//
// They are placed by eye on slices of that scan, not segmented: tubes and a sheet about splines in its W
// frame, where its bone leaves room for them. The sigmoid sinus is about 9 mm wide, the facial nerve 2 mm
// with its sheath. Another scan has them elsewhere. It is for start-up only, since it allocates.
#pragma once

#include <cstdint>
#include <vector>

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

enum class SkullLabel : uint8_t { kNone, kSigmoidSinus, kFacialNerve, kDura };

// These are that scan's, as importVolume gives it, to tell it from others.
inline const Eigen::Vector3i kCraniumDims{256, 256, 108};

// There is one per voxel, x fastest.
std::vector<uint8_t> skullLabels(const VolumeGeometry& geometry);

}  // namespace bonemill
