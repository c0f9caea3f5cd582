// Reads what guests send: any bytes. Thread-safe; never throws on any bytes (other than std::bad_alloc).
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "proto/gateway.pb.h"

namespace bonemill::gateway {

inline constexpr size_t kMaxFrameBytes = 16 << 10;
// A guest that comes again lists what it holds.
inline constexpr size_t kMaxHelloBytes = 256 << 10;
inline constexpr size_t kMaxTokenBytes = 128;

// Returns what the frame says if its numbers are ones to compute with; nothing for all else.
std::optional<FromGuest> parseFromGuest(std::string_view frame);

}  // namespace bonemill::gateway
