#pragma once

#include <CLI/CLI.hpp>

namespace bonemill::bench {

void addLawsCommand(CLI::App& app);

}  // namespace bonemill::bench
