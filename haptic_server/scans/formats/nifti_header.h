// Checks a NIfTI-1 header before the NIfTI library trusts its numbers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "haptic_server/scans/frame/physical_frame.h"

namespace bonemill {

struct NiftiHeader {
    uint64_t data_offset = 0;      // bytes of the unpacked file before the voxels
    uint64_t bytes_per_voxel = 0;  // in the file; scaled values take more when they are read
    // Of the sform where it is set, else of the qform, as the standard says; where neither is set, it does
    // not know the patient.
    FilePlace place = {};
    std::string remark = {};  // for people, where both are set and disagree; else empty
};

// Throws UserError naming the file when it is no single-file NIfTI-1 (.nii, .nii.gz) or its header cannot be
// right.
NiftiHeader readNiftiHeader(const std::filesystem::path& path);

}  // namespace bonemill
