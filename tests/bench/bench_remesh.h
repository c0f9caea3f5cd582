// `haptic_bench remesh` measures the time from the tick that cuts until the mesher has handed the cut's
// meshes to the publisher.
#pragma once

#include <CLI/CLI.hpp>

namespace bonemill::bench {

void addRemeshCommand(CLI::App& app);

}  // namespace bonemill::bench
