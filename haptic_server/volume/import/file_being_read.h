// Tells the guarding process which file a reader is at (guarded_import.h). No Eigen in here: ITK's sources
// include it.
#pragma once

#include <filesystem>

namespace bonemill {

// For the message when the reader dies. No effect outside importGuarded.
void noteFileBeingRead(const std::filesystem::path& file) noexcept;

}  // namespace bonemill
