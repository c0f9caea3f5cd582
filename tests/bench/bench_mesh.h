// `haptic_bench mesh` measures the whole surface beside VTK's flying edges, and single leaves after a cut.
#pragma once

#include <CLI/CLI.hpp>

namespace bonemill::bench {

void addMeshCommand(CLI::App& app);

}  // namespace bonemill::bench
