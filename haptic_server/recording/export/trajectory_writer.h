// What went into a session's ticks as a trajectory for `simulate`, which comes to the same bits with it
// (docs/research/simulate.md).
#pragma once

#include <string>

#include "haptic_server/recording/rerun/recording.h"

namespace bonemill {

// A session whose bone was put back is written up to there; the log says so. Throws UserError if the file
// cannot be written.
void writeTrajectory(const std::string& path, const Recording& recording);

}  // namespace bonemill
