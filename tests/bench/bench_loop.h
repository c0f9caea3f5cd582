// `haptic_bench loop`: the tick in real time beside a bare timer, which shows what the machine itself is
// late.
#pragma once

#include <CLI/CLI.hpp>

namespace bonemill::bench {

void addLoopCommand(CLI::App& app);

}  // namespace bonemill::bench
