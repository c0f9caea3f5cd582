// Runs a reader in a child process of its own, so that no file can bring this process down.
//
// Debian builds GDCM with its assertions on, and ITK's linear algebra aborts on numbers that are not finite:
// a damaged file can end the process that reads it. The child hands the volume over through a pipe, giving
// back the memory of what is through, writes nothing to stderr, and is ended when it hangs, takes more memory
// than is free, or has said all. It reads files and nothing else (confine_reader.h). It is for one thread at
// a time. A child that is forked from a process with threads can hang, which is why a program with threads
// starts a reader of its own instead (import_volume.h).
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// It is measured by the clock on the wall, for a reader that waits for a disk or a network uses no processor
// time. The largest volumes take a minute.
inline constexpr std::chrono::milliseconds kMaxImportTime = std::chrono::minutes(10);

// Returns what `read` returns. Throws UserError: the one that `read` threw, or one that names the file it was
// reading when it died or when `most` had gone by (noteFileBeingRead; `path`, if it did not say).
RawVolume importGuarded(const std::filesystem::path& path, const std::function<RawVolume()>& read,
                        std::chrono::milliseconds most = kMaxImportTime);

// Starts a process that calls readAsChild(), and returns its number, or -1. Its arguments are the ends for
// the child: the pipe, and memory for the name of the file that it reads.
using StartReader = std::function<pid_t(int pipe, int name)>;
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
