// Where a session puts its files, and what its journal says of itself at its start. It is for normal threads,
// and looks at the disk.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/config/scene_file.h"
#include "common/files/require_apart.h"
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
                              const SceneSetup& simulation);

// Where the scenes of a session put their files: never over what any scene that can be chosen reads, and a
// later scene's never over what is there already. It belongs to one normal thread.
class ResultFiles {
  public:
    // `read` are the files of all scenes. Throws UserError if the session's own names are among them.
    ResultFiles(ServerOptions session, std::vector<NamedFile> read);

    const ServerOptions& first() const noexcept { return session_; }
    // The options of the next scene, "out/trace_2.csv" for "out/trace.csv": the next number that is free for
    // all files. Devices stay. Throws UserError if none is.
    ServerOptions next(const std::string& scene) const;
    // That scene is in force now, and its names are taken.
    void take(const ServerOptions& options);

  private:
    ServerOptions numbered(const std::string& scene, int number) const;
    bool isFree(const ServerOptions& options) const;

    ServerOptions session_;
    std::vector<NamedFile> taken_;  // what is read, and what is written
    int last_ = 1;
};

}  // namespace bonemill
