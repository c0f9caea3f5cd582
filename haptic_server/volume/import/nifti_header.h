// Checks a NIfTI-1 header before the NIfTI library trusts its numbers.
#pragma once

#include <cstdint>
#include <filesystem>

namespace bonemill {

// The voxels begin there, in bytes of the unpacked file. Throws UserError naming the file when it is no
// single-file NIfTI-1 (.nii, .nii.gz) or its header cannot be right.
uint64_t readNiftiDataOffset(const std::filesystem::path& path);

}  // namespace bonemill
