// Gives an MCAP file that was torn, as by a crash, its end back. It is for normal threads.
#pragma once

#include <filesystem>

#include "common/mcap/mcap_reader.h"

namespace bonemill::mcap {

// Cuts the file behind the last that is whole and writes index and footer there, so that every tool can read
// it. A whole file is left as it is. If it is stopped itself, the file is torn as before and can be repaired
// again. Returns what was found before. Throws UserError if it is no MCAP file, or cannot be read or written.
Reading repair(const std::filesystem::path& path);

}  // namespace bonemill::mcap
