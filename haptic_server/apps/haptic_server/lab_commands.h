// Commands of bonemill_lab that people may give to haptic_server, too.
#pragma once

#include <CLI/CLI.hpp>

namespace bonemill {

// Adds them to the app's help. The first of them in the command line ends parsing: the program becomes the
// bonemill_lab beside it, with the same words, and says so on stderr. Throws UserError if there is none.
void addLabCommands(CLI::App& app, char** argv);

}  // namespace bonemill
