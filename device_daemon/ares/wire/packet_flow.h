// This watches the packets that come from the other side in one session: which are new, how many were lost or
// late, and whether both directions have proved themselves.
//
// Times are CLOCK_MONOTONIC ns and come in as parameters. It is RT-safe, for one thread.
#pragma once

#include <cstdint>

namespace bonemill::wire {

// These bound the watchdog of either side.
inline constexpr uint32_t kShortestWatchdogUs = 2000;
inline constexpr uint32_t kDefaultWatchdogUs = 5000;
inline constexpr uint32_t kLongestWatchdogUs = 30000;

// This many good packets in a row, and this many of ours reflected by them, make a link that is trusted.
inline constexpr uint32_t kPacketsUntilTrusted = 10;
// A packet is late when it comes N periods after the one before, and its sender did not pause either.
inline constexpr double kLatePeriods = 1.5;
// The leaky bucket: it fills when more than a fifth of the packets is late for long, or 25 in a row.
inline constexpr int kLateDrops = 4;  // that a late packet adds; one in time takes one away
inline constexpr int kLateBucket = 100;

struct FlowStatistics {
    uint64_t accepted = 0;
    uint64_t lost = 0;      // their numbers never came, or came too late to matter
    uint64_t late = 0;      // accepted, but late: the wire kept it, or lost those before
    uint64_t paused = 0;    // accepted, but sent late: the other side's PC was busy
    uint64_t old = 0;       // duplicates, and packets that others have overtaken
    uint64_t rejected = 0;  // not well-formed, of a stranger, or of another session
};

class PacketFlow {
  public:
    // A session begins: the other side's packet with number `sequence` came, and the newest packet of ours
    // was `own_sequence`. The statistics go on.
    void begin(uint32_t sequence, uint32_t own_sequence, int64_t period_ns, int64_t now_ns) noexcept;

    // A well-formed packet of the session came at now_ns, which by the sender's clock was sent at sent_ns.
    // False says that it is to be ignored: it is no newer than another, or it reflects a packet that this
    // side has not sent in this session.
    bool accept(uint32_t sequence, uint32_t reflected, uint32_t own_sequence, int64_t sent_ns,
                int64_t now_ns) noexcept;
    // One that reflects nothing, such as a second request, uses up its number.
    bool skip(uint32_t sequence) noexcept;
    // Counts what was refused. `breaks_row` if it came from the other side.
    void reject(bool breaks_row) noexcept;

    bool isTrusted() const noexcept { return is_trusted_; }
    // The bucket ran over, and has not been empty since.
    bool tooManyLate() const noexcept { return too_many_late_; }
    uint32_t newestSequence() const noexcept { return newest_; }
    int64_t newestNs() const noexcept { return newest_ns_; }
    const FlowStatistics& statistics() const noexcept { return statistics_; }

  private:
    void countTime(uint32_t lost, int64_t sent_ns, int64_t now_ns) noexcept;
    void growRow(uint32_t lost, uint32_t reflected) noexcept;
    void breakRow(uint32_t reflected) noexcept;

    uint32_t newest_ = 0;
    int64_t newest_ns_ = 0;
    int64_t newest_sent_ns_ = 0;  // by the sender's clock
    bool has_sent_ = false;
    int64_t period_ns_ = 0;
    uint32_t first_own_ = 0;  // nothing before this one can be reflected
    uint32_t reflected_ = 0;
    bool is_trusted_ = false;
    uint32_t row_ = 0;            // good packets in a row
    uint32_t row_reflected_ = 0;  // what was reflected when the row began
    int bucket_ = 0;
    bool too_many_late_ = false;
    FlowStatistics statistics_;
};

}  // namespace bonemill::wire
