// What opens archives of scans in this build: every_reader.cpp, or nrrd_reader.cpp where it opens none.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "haptic_server/scans/confined/guarded_process.h"

namespace bonemill {

bool isPacked(const std::filesystem::path& path);

// For the child: hands over the files of the archive, and ends the process.
[[noreturn]] void sendPackedAsChild(int pipe, const std::filesystem::path& path);

// Calls `read` with the scan, unpacked for so long, and with what names its files in a text as people know
// them. `start` starts a process that calls sendPackedAsChild(). Throws UserError.
using ReadUnpacked = std::function<void(const std::filesystem::path& scan,
                                        const std::function<std::string(const std::string&)>& named)>;
void readUnpacked(const std::filesystem::path& path, const StartReader& start, const ReadUnpacked& read);

}  // namespace bonemill
