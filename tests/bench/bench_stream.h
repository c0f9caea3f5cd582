// `haptic_bench stream`: bytes on the wire, and a session that mills with 1, 10, 30 viewers.
#pragma once

#include <CLI/CLI.hpp>

namespace bonemill::bench {

void addStreamCommand(CLI::App& app);

}  // namespace bonemill::bench
