// Reads an InVesalius 3 project (.inv3): a compressed tar archive of main.plist and the matrix file it names.
//
// The plist's shape counts slices, rows, columns (docs/teach/volumes.md); spacing is given column, row, slice
// in mm; columns run to the patient's left, slices upwards, and InVesalius stores the rows from back to front
// (it flips the rows of each DICOM slice), so they are reversed here. The project keeps no origin: W has its
// origin at the centre of voxel (0, 0, 0).
#pragma once

#include <filesystem>

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// Throws UserError with one message naming the file.
RawVolume importInv3(const std::filesystem::path& path);

}  // namespace bonemill
