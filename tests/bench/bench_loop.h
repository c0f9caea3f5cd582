// `haptic_bench loop` measures the tick in real time beside a bare timer, which shows how late the machine
// itself is.
#pragma once

#include <CLI/CLI.hpp>

namespace bonemill::bench {

void addLoopCommand(CLI::App& app);

}  // namespace bonemill::bench
