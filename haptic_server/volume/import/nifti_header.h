// Checks a NIfTI-1 header before the NIfTI library trusts its numbers.
#pragma once

#include <cstdint>
#include <filesystem>

namespace bonemill {

struct NiftiHeader {
    uint64_t data_offset = 0;        // bytes of the unpacked file before the voxels
    bool has_patient_space = false;  // qform or sform are set: they name the patient's sides
};

// Throws UserError naming the file when it is no single-file NIfTI-1 (.nii, .nii.gz) or its header cannot be
// right.
NiftiHeader readNiftiHeader(const std::filesystem::path& path);

}  // namespace bonemill
