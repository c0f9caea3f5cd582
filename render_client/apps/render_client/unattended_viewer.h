// The viewer without a user: it writes pictures or a video, or measures what drawing costs.
#pragma once

#include "render_client/viewer_options/viewer_options.h"

namespace bonemill {

// Writes pictures into a folder, and one JSON line per picture to stdout. Runs until all pictures are written
// or a stop signal comes. Throws UserError (folder, DDS domain), GlError, and std::runtime_error when
// --wait-complete ran out of time.
void runOffscreen(const ClientOptions& options);

// Makes a video of what it sees, and prints one JSON line about it to stdout. Runs until the session ends,
// the wanted time is over, or a stop signal comes; the video is whole then. A second of the video is a second
// of the session, or of the recording that is replayed, at whatever speed. Throws UserError (file, ffmpeg,
// DDS domain), GlError, and std::runtime_error when no server came in time.
void runVideo(const ClientOptions& options);

// Draws as fast as it can, without files, and prints what it costs as one JSON object on stdout: off screen
// by the processor, or in a window by what draws there. Runs for options.measure->time once the model is
// complete, or until a stop signal comes. Throws UserError (DDS domain, no display), GlError, and
// std::runtime_error when no model came in time.
void runMeasurement(const ClientOptions& options);

}  // namespace bonemill
