// Reads a volume in a process of its own (guarded_process.h). The child hands it over through a pipe, giving
// back the memory of what is through. It is for one thread at a time.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "haptic_server/core/volume/raw_volume.h"
#include "haptic_server/scans/confined/guarded_process.h"

namespace bonemill {

// Returns what `read` returns. Throws UserError: the one that `read` threw, or one that names the file it was
// reading when it died or when `most` had gone by (noteFileBeingRead; `path`, if it did not say).
RawVolume importGuarded(const std::filesystem::path& path, const std::function<RawVolume()>& read,
                        std::chrono::milliseconds most = kMaxImportTime);

// The process calls readAsChild().
RawVolume importFrom(const std::filesystem::path& path, const StartReader& start,
                     std::chrono::milliseconds most = kMaxImportTime);

// For the child: hands over what `read` returns, or why not, and ends the process.
[[noreturn]] void readAsChild(int pipe, const std::filesystem::path& path,
                              const std::function<RawVolume()>& read);

// The same for lines of text instead of a volume. Whatever the reader wrote, they are printable ASCII.
using Lines = std::vector<std::string>;
Lines linesGuarded(const std::filesystem::path& path, const std::function<Lines()>& read,
                   std::chrono::milliseconds most = kMaxImportTime);
Lines linesFrom(const std::filesystem::path& path, const StartReader& start,
                std::chrono::milliseconds most = kMaxImportTime);
[[noreturn]] void readLinesAsChild(int pipe, const std::filesystem::path& path,
                                   const std::function<Lines()>& read);

}  // namespace bonemill
