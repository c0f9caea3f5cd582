// The files in which a volume has its voxels, where a header names them: a detached NRRD or MetaImage. It is
// for start-up only.
#pragma once

#include <filesystem>
#include <vector>

namespace bonemill {

// One file, a LIST of them, or a pattern with numbers, as both formats write them; none for any other volume,
// and none for a header that makes no sense, of which the import says so. Throws UserError if they are more
// than anybody's volume has.
std::vector<std::filesystem::path> detachedDataOf(const std::filesystem::path& volume);

}  // namespace bonemill
