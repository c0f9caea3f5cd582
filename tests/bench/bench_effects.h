// `haptic_bench effects` measures what each effect adds to a tick that mills a block, on this machine.
#pragma once

#include <CLI/CLI.hpp>

namespace bonemill::bench {

void addEffectsCommand(CLI::App& app);

}  // namespace bonemill::bench
