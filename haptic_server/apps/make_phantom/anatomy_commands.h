// These are make_phantom's subcommands for whole anatomy: vertebra and skull_labels.
#pragma once

#include <CLI/CLI.hpp>

namespace bonemill {

// They run while `app` parses, and throw UserError.
void addAnatomyCommands(CLI::App& app);

}  // namespace bonemill
