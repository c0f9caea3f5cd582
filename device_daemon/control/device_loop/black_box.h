// Keeps the last two seconds of samples and commands, so that a stop can be understood afterwards, and says
// where they are written.
//
// The loop's thread records; kAfterNs after a stop, or at the loop's end, the box holds still until another
// thread has written it to a file. record() and finish() are RT-safe; the constructor and write() are not.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "common/base/units.h"
#include "common/device_messages/device_messages.h"
#include "common/device_messages/device_state.h"

namespace bonemill {

struct BlackBoxRecord {
    int64_t time_ns;  // CLOCK_MONOTONIC
    DeviceSample sample;
    WrenchCommand command;  // the newest one then; all zero if there was none
    double f_given_D[3];    // N, to the device
    double t_given_D[3];    // N·m
    bool is_heard;          // the device gave a reading in this period
};

class BlackBox {
  public:
    static constexpr int64_t kBeforeNs = 2 * kNsPerSecond;
    static constexpr int64_t kAfterNs = 100 * kNsPerMillisecond;
    // Of a device that is faster, only one record in so long a time is kept.
    static constexpr int64_t kShortestPeriodNs = 100 * kNsPerMicrosecond;

    // `before` is the cause of a stop that an earlier box has written.
    explicit BlackBox(StopCause before = StopCause::kNone);

    // `cause` is what holds the device now; a new one is a stop.
    void record(const BlackBoxRecord& record, StopCause cause) noexcept;
    // Nothing more comes: a stop of just now is held as it is. For the thread that records.
    void finish() noexcept;

    // The cause of the stop that is held; once isFull(), for any thread.
    StopCause cause() const noexcept { return stop_cause_; }
    // Any thread may ask: a stop is to be written.
    bool isFull() const noexcept { return is_full_.load(std::memory_order_acquire); }
    // Writes what is held as CSV, oldest first, and lets the box record again. Only when isFull(). Throws
    // UserError.
    void write(const std::filesystem::path& file);

  private:
    void keep(const BlackBoxRecord& record, bool is_stop) noexcept;

    std::vector<BlackBoxRecord> records_;
    size_t next_ = 0;
    size_t count_ = 0;
    int64_t due_ns_ = 0;        // of the next record that is kept
    bool is_stopping_ = false;  // a stop has come, and what is after it still comes
    int64_t stop_ns_ = 0;
    StopCause last_cause_;
    StopCause stop_cause_ = StopCause::kNone;  // of the stop under way
    std::atomic<bool> is_full_ = false;
};

// Returns $XDG_STATE_HOME/bonemill, or ~/.local/state/bonemill.
std::filesystem::path defaultStopDir();

// A device that stops again and again fills no disk: the newest N files stay in the folder.
inline constexpr size_t kMaxStopFiles = 100;

// Returns a new name in the folder, which is made if need be: stop_SESSION_TIME_CAUSE.csv. Makes room for it
// by removing the oldest files of such names. Never throws: a folder that cannot be made shows when the file
// is written.
std::filesystem::path stopFile(const std::filesystem::path& dir, uint32_t session, StopCause cause);

}  // namespace bonemill
