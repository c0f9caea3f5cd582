// The scene of a recorded session, and whether the files that it reads are still those that were read then. A
// journal may come from a stranger: what it does not list with its hash is not opened. For normal threads, at
// the start.
#pragma once

#include <string>
#include <vector>

#include "common/config/scene_file.h"
#include "proto/journal.pb.h"

namespace bonemill {

// The scene whose text the journal has, its paths as of the file that it came from. `journal` names the file
// of the recording, for messages. Throws UserError, also if the scene reads a file that the journal does not
// list.
LoadedScene recordedScene(const journal::Manifest& manifest, const std::string& journal);

// Which of the files that the scene reads are others now than the journal says, a sentence each.
std::vector<std::string> changedFiles(const journal::Manifest& manifest, const LoadedScene& scene);

}  // namespace bonemill
