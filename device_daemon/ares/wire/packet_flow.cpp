#include "device_daemon/ares/wire/packet_flow.h"

#include <algorithm>

#include "common/rt/clock.h"
#include "device_daemon/ares/wire/packets.h"

namespace bonemill::wire {

void PacketFlow::begin(uint32_t sequence, uint32_t own_sequence, int64_t period_ns, int64_t now_ns) noexcept {
    const FlowStatistics so_far = statistics_;
    *this = {};
    statistics_ = so_far;
    newest_ = sequence;
    newest_ns_ = now_ns;
    period_ns_ = period_ns;
    first_own_ = own_sequence;
    breakRow(own_sequence);
    reflected_ = own_sequence;
}

bool PacketFlow::accept(uint32_t sequence, uint32_t reflected, uint32_t own_sequence, int64_t sent_ns,
                        int64_t now_ns) noexcept {
    if (!isNewer(sequence, newest_)) {
        ++statistics_.old;
        return false;
    }
    const bool goes_back = isNewer(reflected_, reflected);
    const bool is_invented = isNewer(reflected, own_sequence) || isNewer(first_own_, reflected);
    if (goes_back || is_invented) {
        reject(true);
        return false;
    }
    const uint32_t lost = sequence - newest_ - 1;
    statistics_.lost += lost;
    ++statistics_.accepted;
    countTime(lost, sent_ns, now_ns);
    growRow(lost, reflected);
    newest_ = sequence;
    newest_ns_ = now_ns;
    reflected_ = reflected;
    return true;
}

bool PacketFlow::skip(uint32_t sequence) noexcept {
    if (!isNewer(sequence, newest_)) {
        ++statistics_.old;
        return false;
    }
    newest_ = sequence;
    return true;
}

void PacketFlow::reject(bool breaks_row) noexcept {
    ++statistics_.rejected;
    if (breaks_row) breakRow(reflected_);
}

// A sender whose PC is busy pauses, and says so by its stamps: no other wire would mend that. The watchdog
// bounds how long it may. What the wire has lost is no pause.
void PacketFlow::countTime(uint32_t lost, int64_t sent_ns, int64_t now_ns) noexcept {
    const double most_ns = kLatePeriods * double(period_ns_);
    const bool has_paused =
        has_sent_ && double(nsBetween(newest_sent_ns_, sent_ns)) > most_ns * (double(lost) + 1);
    const bool came_late = double(now_ns - newest_ns_) > most_ns;
    const bool is_late = came_late && !has_paused;
    newest_sent_ns_ = sent_ns;
    has_sent_ = true;
    statistics_.late += is_late;
    statistics_.paused += came_late && has_paused;
    bucket_ = std::clamp(bucket_ + (is_late ? kLateDrops : -1), 0, kLateBucket);
    if (bucket_ == kLateBucket) too_many_late_ = true;
    if (bucket_ == 0) too_many_late_ = false;
}

void PacketFlow::growRow(uint32_t lost, uint32_t reflected) noexcept {
    if (lost > 0) breakRow(reflected);
    ++row_;
    if (row_ >= kPacketsUntilTrusted && reflected - row_reflected_ >= kPacketsUntilTrusted)
        is_trusted_ = true;
}

void PacketFlow::breakRow(uint32_t reflected) noexcept {
    row_ = 0;
    row_reflected_ = reflected;
}

}  // namespace bonemill::wire
