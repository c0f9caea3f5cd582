// Where the scenes of a session put their files: never over what any scene that can be chosen reads, and a
// later scene's never over what is there already. It belongs to one normal thread, and looks at the disk.
#pragma once

#include <vector>

#include "common/files/require_apart.h"
#include "haptic_server/server/session/server.h"

namespace bonemill {

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
