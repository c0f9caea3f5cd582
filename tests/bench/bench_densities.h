// `haptic_bench densities` measures how a scan's densities are coded for viewers: bytes and processor time.
#pragma once

#include <CLI/CLI.hpp>

namespace bonemill::bench {

void addDensitiesCommand(CLI::App& app);

}  // namespace bonemill::bench
