// A file that only grows, written by a thread of its own, so that nobody waits for the disk; another one has
// it written through once per second, for the loss of power. What does not fit on the disk, or comes faster
// than it takes, is left out from there to the end, so that what is there stays whole. As long as the file is
// open it is locked (flock), so that others see that somebody writes to it.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>

namespace bonemill {

// Tells whether somebody writes to it; a file that cannot be opened counts as such.
bool isJournalWritten(const std::filesystem::path& path);

class JournalFile {
  public:
    // As much waits for the disk at most.
    static constexpr size_t kMostWaiting = size_t(64) << 20;

    // Makes the file, which must not be there yet, and its folders; only its user may read it. Throws
    // UserError.
    explicit JournalFile(const std::filesystem::path& path);
    ~JournalFile();
    JournalFile(const JournalFile&) = delete;
    JournalFile& operator=(const JournalFile&) = delete;

    const std::filesystem::path& path() const noexcept { return path_; }

    // One normal thread: these bytes come next, all or none of them. It never waits for the disk.
    void append(std::string bytes);
    // Any thread: why something was left out, for people; empty if nothing was.
    std::string problem() const;
    // The thread that appends: waits until all that came is written, or left out.
    void flush();
    // Likewise, until it is on the disk. Nothing may come after.
    void finish();

  private:
    void writeUntilFinished();
    bool write(const std::string& bytes);
    void syncUntilFinished(const std::stop_token& stop);
    void fail(const std::string& why);

    std::filesystem::path path_;
    int file_ = -1;
    uint64_t size_ = 0;  // of what is whole; the writing thread's
    mutable std::mutex mutex_;
    std::condition_variable has_changed_;
    std::deque<std::string> waiting_;  // guarded, as all below
    size_t waiting_bytes_ = 0;
    bool is_finishing_ = false, is_writing_ = false;
    std::string problem_;
    std::condition_variable_any is_stopping_;
    std::jthread writer_, syncer_;
};

}  // namespace bonemill
