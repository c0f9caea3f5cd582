// What the trainee saw, as datasets of an HDF5 file.
#pragma once

#include "haptic_server/recording/export/h5_file.h"
#include "haptic_server/recording/rerun/recording.h"

namespace bonemill {

// Reads the journal once more; adds "/eye" where it holds any. Throws UserError.
void writeEyes(const Recording& recording, H5File& file);

}  // namespace bonemill
