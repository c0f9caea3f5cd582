// The input of many ticks as columns, some 40 bytes per tick when they are packed (proto/journal.proto,
// Inputs), and back to the bit; and what the ticks came to (Results). It is for normal threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "haptic_server/core/telemetry/tick_record.h"
#include "proto/journal.pb.h"

namespace bonemill {

// What ticks came to, as columns of one message.
class ResultColumns {
  public:
    void add(const TickRecord& record);
    bool isEmpty() const noexcept { return results_.count() == 0; }
    journal::Results take();

  private:
    journal::Results results_;
};

// One tick's input, as its TickRecord has it.
struct JournalTick {
    uint64_t tick = 0;
    int64_t start_ns = 0;  // since the journal's first tick
    uint32_t buttons = 0;
    DeviceReport device;
    TickInput input{};
    uint16_t check = 0;  // TickHash::check() after it
};

// Since the journal's first tick, which started at first_start_ns.
JournalTick journalTickOf(const TickRecord& record, int64_t first_start_ns, uint16_t check) noexcept;

// So many ticks make one message at most.
inline constexpr size_t kMaxTicksPerInputs = 1024;

// The ticks are consecutive, and not more than that.
void encodeInputs(std::span<const JournalTick> ticks, journal::Inputs& out);
// Appends; false if that is no message of encodeInputs(): then nothing is appended. No tick has what cannot
// be: a capability, a factor or a number of periods out of range.
bool decodeInputs(const journal::Inputs& inputs, std::vector<JournalTick>& ticks);

}  // namespace bonemill
