// Tells the guarding process which file a reader is at (guarded_import.h). No Eigen may be in here: ITK's
// sources include it.
#pragma once

#include <filesystem>

namespace bonemill {

// The message names it when the reader dies. It has no effect outside importGuarded.
void noteFileBeingRead(const std::filesystem::path& file) noexcept;

}  // namespace bonemill
