// Finds words for the TickFault bits. Any thread may call it; it allocates.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace bonemill {

// There is one short name per set bit, lowest bit first ("overrun", "stale_device", ...), and "unknown_bit_N"
// for a bit without one.
std::vector<std::string> faultList(uint32_t faults);

// Says the same for people: "overrun, stale_device", or "none".
std::string faultNames(uint32_t faults);

}  // namespace bonemill
