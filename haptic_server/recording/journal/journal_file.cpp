#include "haptic_server/recording/journal/journal_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <utility>

#include "common/base/user_error.h"

namespace bonemill {

bool isJournalWritten(const std::filesystem::path& path) {
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    if (file < 0) return true;
    const bool is_locked = flock(file, LOCK_SH | LOCK_NB) != 0;
    close(file);
    return is_locked;
}

JournalFile::JournalFile(const std::filesystem::path& path) : path_(path) {
    std::error_code error;
    std::filesystem::create_directories(path.parent_path(), error);  // the opening says what is wrong
    file_ = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_NOFOLLOW | O_CLOEXEC,
                 S_IRUSR | S_IWUSR);
    if (file_ < 0)
        throw UserError(path.string() + ": the recording cannot be written (" + std::strerror(errno) +
                        "); name another folder with --recording, or refuse it with --no-recording");
    flock(file_, LOCK_EX | LOCK_NB);  // where there are no locks nobody sees that it is written
    writer_ = std::jthread([this] { writeUntilFinished(); });
    syncer_ = std::jthread([this](const std::stop_token& stop) { syncUntilFinished(stop); });
}

JournalFile::~JournalFile() {
    finish();
}

void JournalFile::append(std::string bytes) {
    if (bytes.empty()) return;
    const std::lock_guard lock(mutex_);
    if (!problem_.empty()) return;
    if (waiting_bytes_ + bytes.size() > kMostWaiting) {
        problem_ = "the disk is too slow";
        return;
    }
    waiting_bytes_ += bytes.size();
    waiting_.push_back(std::move(bytes));
    has_changed_.notify_all();
}

std::string JournalFile::problem() const {
    const std::lock_guard lock(mutex_);
    return problem_;
}

void JournalFile::flush() {
    std::unique_lock lock(mutex_);
    has_changed_.wait(lock, [this] { return waiting_.empty() && !is_writing_; });
}

void JournalFile::finish() {
    if (file_ < 0) return;
    {
        const std::lock_guard lock(mutex_);
        is_finishing_ = true;
        has_changed_.notify_all();
    }
    writer_.join();
    syncer_.request_stop();
    syncer_.join();
    fdatasync(file_);
    close(std::exchange(file_, -1));
}

void JournalFile::writeUntilFinished() {
    // A file beyond the user's limit is an error as any other.
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGXFSZ);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    for (;;) {
        std::string bytes;
        {
            std::unique_lock lock(mutex_);
            has_changed_.wait(lock, [this] { return is_finishing_ || !waiting_.empty(); });
            if (waiting_.empty()) return;
            bytes = std::move(waiting_.front());
            waiting_.pop_front();
            is_writing_ = true;
        }
        const bool is_written = write(bytes);
        const std::lock_guard lock(mutex_);
        waiting_bytes_ -= bytes.size();
        is_writing_ = false;
        if (!is_written) {
            waiting_.clear();
            waiting_bytes_ = 0;
        }
        has_changed_.notify_all();
    }
}

// What is not there whole is taken back.
bool JournalFile::write(const std::string& bytes) {
    for (size_t done = 0; done < bytes.size();) {
        const ssize_t count = ::write(file_, bytes.data() + done, bytes.size() - done);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) {
            fail(std::strerror(errno));
            return false;
        }
        done += size_t(count);
    }
    size_ += bytes.size();
    return true;
}

void JournalFile::fail(const std::string& why) {
    const bool is_torn =
        ftruncate(file_, off_t(size_)) != 0;  // it may take long, and others wait for the lock
    const std::lock_guard lock(mutex_);
    problem_ = why + (is_torn ? ", and its end is torn" : "");
}

void JournalFile::syncUntilFinished(const std::stop_token& stop) {
    std::mutex mutex;
    std::unique_lock lock(mutex);
    while (!is_stopping_.wait_for(lock, stop, std::chrono::seconds(1), [] { return false; }) &&
           !stop.stop_requested())
        fdatasync(file_);
}

}  // namespace bonemill
