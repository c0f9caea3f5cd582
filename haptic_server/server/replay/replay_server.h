// Shows a recorded session as a live one, to any number of viewers: `bonemill_lab replay`
// (docs/howto/replay.md).
#pragma once

#include <cstdint>
#include <string>

#include "common/dds/network.h"
#include "haptic_server/server/replay/compared_attempt.h"

namespace bonemill {

struct ReplayOptions {
    std::string journal;
    uint32_t session = 1;
    uint32_t domain = 0;
    dds::NetworkOptions network;
    double at_s = 0;  // begins there
    double speed = 1;
    bool is_paused = false;  // until a viewer lets it go on
    double stream_mbit_per_s = 200;
    bool instructor_only = false;
    AttemptName against;     // to compare with; an empty file: none
    AttemptFolders folders;  // in which viewers may choose one
    std::string version;     // that --version prints
};

// Runs until told to stop; returns the process' exit code. Throws UserError at start-up.
int runReplay(const ReplayOptions& options);

}  // namespace bonemill
