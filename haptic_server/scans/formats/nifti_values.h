// Reads the voxels of a NIfTI-1 file, scaled in double as its header says: libraries scale in float, which
// whole numbers above 2^24 do not survive.
#pragma once

#include <cstdint>
#include <filesystem>

#include "haptic_server/core/volume/raw_values.h"
#include "haptic_server/scans/formats/nifti_header.h"

namespace bonemill {

// Of a voxel in the file. Throws UserError naming it when its type is not a plain number.
uint64_t niftiVoxelBytes(const NiftiHeader& header, const std::filesystem::path& path);

struct NiftiValues {
    RawValues values;
    uint64_t surplus = 0;    // bytes behind the voxels; of a packed file the first few at most
    bool is_packed = false;  // by gzip, whatever the file is called
};

// The sizes of the header have been found sensible. It is for start-up only. Throws UserError naming the file
// when it holds fewer voxels than its header says, or is damaged.
NiftiValues readNiftiValues(const std::filesystem::path& path, const NiftiHeader& header);

}  // namespace bonemill
