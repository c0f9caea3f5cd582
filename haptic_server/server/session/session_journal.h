// Where the journal of a session goes, and what it says of itself at its start. It is for normal threads,
// before the session runs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "common/config/scene_file.h"
#include "haptic_server/recording/journal/journal.h"
#include "haptic_server/scene/setup/scene_setup.h"
#include "haptic_server/server/session/server.h"

namespace bonemill {

// $XDG_STATE_HOME/bonemill/recordings, or the same in ~/.local/state; empty if the environment names neither.
std::filesystem::path defaultRecordingFolder();
// Makes the folder if there is none. Throws UserError if nothing can be written there.
void requireRecordable(const ServerOptions& options);

// "SESSION_SCENE_20261125T093000Z.mcap" in the folder, with a number behind it if that is there already.
std::filesystem::path newJournalPath(const std::filesystem::path& folder, uint32_t session,
                                     const std::filesystem::path& scene);

// Reads all files of the scene once more, for their digests. Throws UserError.
JournalConfig journalConfigOf(const ServerOptions& options, const LoadedScene& loaded,
                              const Simulation& simulation);

}  // namespace bonemill
