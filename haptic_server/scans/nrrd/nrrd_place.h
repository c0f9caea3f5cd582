// Our own reading of where a NRRD file's voxels lie: ITK turns the wrong axis of the space LAS, and none of
// the spaces that have time as a fourth axis.
#pragma once

#include <optional>
#include <string>

#include "haptic_server/scans/frame/physical_frame.h"
#include "haptic_server/scans/nrrd/nrrd_header.h"

namespace bonemill {

// Where the file does not say the voxels' size it is 1 mm. Throws UserError naming `file` where it has other
// than three axes in space, a space that is none of the format's, one that is left-handed without sides of
// the patient, or vectors that do not fit.
FilePlace nrrdPlaceOf(const NrrdHeader& header, const std::string& file);

// Throws as above for what is wrong with the space alone.
void checkNrrdSpace(const NrrdHeader& header, const std::string& file);

}  // namespace bonemill
