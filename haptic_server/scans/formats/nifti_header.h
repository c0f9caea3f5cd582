// Reads a NIfTI-1 header, and believes none of its numbers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "haptic_server/scans/frame/physical_frame.h"

namespace bonemill {

struct NiftiHeader {
    std::vector<uint64_t> dims;  // all axes
    int datatype = 0;            // a code of nifti1.h
    bool is_swapped = false;     // the file's numbers are of the other byte order
    uint64_t data_offset = 0;    // bytes of the unpacked file before the voxels
    double slope = 1, intercept = 0;
    // Of the sform where it is set, else of the qform, as the standard says; where neither is set, it does
    // not know the patient.
    FilePlace place = {};
    std::string remark = {};  // for people, where both are set and disagree; else empty
};

// Throws UserError naming the file when it is no single-file NIfTI-1, packed by gzip or not, or its header
// cannot be right.
NiftiHeader readNiftiHeader(const std::filesystem::path& path);

}  // namespace bonemill
