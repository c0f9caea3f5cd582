// `haptic_bench scale` measures how the tick grows with the volume and with the burr.
#pragma once

#include <CLI/CLI.hpp>

namespace bonemill::bench {

void addScaleCommand(CLI::App& app);

}  // namespace bonemill::bench
