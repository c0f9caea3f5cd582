// `haptic_bench load` measures the way from a file to the first tick, and the memory that it takes.
#pragma once

#include <CLI/CLI.hpp>

namespace bonemill::bench {

void addLoadCommand(CLI::App& app);

}  // namespace bonemill::bench
