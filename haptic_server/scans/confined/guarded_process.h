// Runs what reads foreign files in a child process of its own, so that no file can bring this process down.
//
// Debian builds GDCM with its assertions on, and ITK's linear algebra aborts on numbers that are not finite:
// a damaged file can end the process that reads it. The child hands over what it has read through a pipe,
// writes nothing to stderr, and is ended when it hangs, takes more memory than is free, or has said all. It
// reads files and nothing else (confine_reader.h). It is for one thread at a time. A child that is forked
// from a process with threads can hang, which is why a program with threads starts a reader of its own
// instead (import_volume.h).
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "haptic_server/scans/confined/reader_pipe.h"

namespace bonemill {

// It is measured by the clock on the wall, for a reader that waits for a disk or a network uses no processor
// time. The largest volumes take a minute.
inline constexpr std::chrono::milliseconds kMaxImportTime = std::chrono::minutes(10);

// What goes through the pipe begins with words: their kind, and a text. Kinds but that of errors are the
// reader's own.
struct Words {
    uint8_t kind = 0;
    std::string text = {};
};
inline constexpr uint8_t kErrorWords = 0;
inline constexpr uint64_t kMaxWordsBytes = uint64_t(1) << 20;

// It is false when the other end is gone.
bool sendWords(int pipe, uint8_t kind, std::string_view text);

// It is false when the child died, or it was too late, before all was there. Throws the child's UserError,
// and std::length_error when there are more than kMaxWordsBytes.
bool receiveWords(Incoming& from, Words& words);

// For the child: confines this process, calls `send`, which writes into the pipe, and ends the process. What
// `send` throws is handed over as an error.
[[noreturn]] void sendAsChild(int pipe, const std::filesystem::path& path, const std::function<void()>& send);

// Starts a process that calls sendAsChild(), and returns its number, or -1. Its arguments are the ends for
// the child: the pipe, and memory for the name of the file that it reads.
using StartReader = std::function<pid_t(int pipe, int name)>;

// The child is `read` in a copy of this process.
StartReader forkOf(const std::function<void(int pipe)>& read);

// Starts the process and calls `take` for what comes; it returns false when that ended too early, and throws
// std::length_error when it does not fit together. Throws UserError: that of the child or of `take`, or one
// that names the file that was read when the child died or `most` had gone by (noteFileBeingRead; `path`, if
// it did not say).
void receiveFrom(const std::filesystem::path& path, const StartReader& start, std::chrono::milliseconds most,
                 const std::function<bool(Incoming&)>& take);

}  // namespace bonemill
