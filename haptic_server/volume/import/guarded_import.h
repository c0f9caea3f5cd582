// Runs a reader in a child process of its own, so that no file can bring this process down.
//
// Debian builds GDCM with its assertions on, and ITK's linear algebra aborts on numbers that are not finite:
// a damaged file can end the process that reads it. The child hands the volume over through a pipe, giving
// back the memory of what is through, writes nothing to stderr, and is ended when it hangs or takes all
// memory. Start-up only: forks, so best before other threads run.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>

#include "haptic_server/volume/raw_volume.h"

namespace bonemill {

// It is measured by the clock on the wall, for a reader that waits for a disk or a network uses no processor
// time. The largest volumes take a minute.
inline constexpr std::chrono::milliseconds kMostImportTime = std::chrono::minutes(10);

// Returns what `read` returns. Throws UserError: the one that `read` threw, or one that names the file it was
// reading when it died or when `most` had gone by (file_being_read.h; `path`, if it did not say).
RawVolume importGuarded(const std::filesystem::path& path, const std::function<RawVolume()>& read,
                        std::chrono::milliseconds most = kMostImportTime);

}  // namespace bonemill
