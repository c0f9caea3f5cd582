// `haptic_bench stream` counts bytes on the wire, and measures a session that mills with 1, 10 and
// 30 viewers.
#pragma once

#include <CLI/CLI.hpp>

namespace bonemill::bench {

void addStreamCommand(CLI::App& app);

}  // namespace bonemill::bench
