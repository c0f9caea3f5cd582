// Gives an MCAP file that was torn, as by a crash, its end back. It is for normal threads.
#pragma once

#include <filesystem>

#include "common/mcap/mcap_reader.h"

namespace bonemill::mcap {

struct Repair : Reading {
    std::filesystem::path kept;  // the file as it was; empty if only a torn chunk at its end was cut off
};

// What is kept of NAME.mcap is called so.
inline constexpr char kDamagedEnding[] = ".damaged.mcap";

// Cuts the file behind the last that is whole and writes index and footer there, so that every tool can read
// it. A whole file is left as it is. Where more than a torn chunk is lost, the file as it was stays beside
// it, as NAME.damaged.mcap. If it is stopped itself, the file is torn as before and can be repaired again.
// Returns what was found before. Throws UserError if it is no MCAP file, was torn by another program than
// ours, or cannot be read or written.
Repair repair(const std::filesystem::path& path);

}  // namespace bonemill::mcap
