// Checks a NIfTI-1 header before the NIfTI library trusts its numbers.
#pragma once

#include <filesystem>

namespace bonemill {

// Throws UserError naming the file when it is no single-file NIfTI-1 (.nii, .nii.gz) or its header cannot be right.
void checkNiftiHeader(const std::filesystem::path& path);

}  // namespace bonemill
