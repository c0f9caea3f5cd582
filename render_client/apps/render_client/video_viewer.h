// The viewer without a display makes a video of what it sees, and prints one JSON line about it to stdout.
#pragma once

#include "render_client/viewer_options/viewer_options.h"

namespace bonemill {

// Runs until the session ends, the wanted time is over, or a stop signal comes; the video is whole then. A
// second of the video is a second of the session, or of the recording that is replayed, at whatever speed.
// Throws UserError (file, ffmpeg, DDS domain), GlError, and std::runtime_error when no server came in time.
void runVideo(const ClientOptions& options);

}  // namespace bonemill
