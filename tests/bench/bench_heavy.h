// `haptic_bench heavy`: what scenes with many effects and a wide burr take of a tick, in multiples of what
// the tooth's corridor takes in the same run.
#pragma once

#include <CLI/CLI.hpp>

namespace bonemill::bench {

void addHeavyCommand(CLI::App& app);

}  // namespace bonemill::bench
