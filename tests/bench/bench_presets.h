#pragma once

#include <CLI/CLI.hpp>

namespace bonemill::bench {

void addPresetsCommand(CLI::App& app);

}  // namespace bonemill::bench
