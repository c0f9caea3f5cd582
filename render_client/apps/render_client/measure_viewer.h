// Draws as fast as it can, without files, and prints what it costs as one JSON object on stdout: off screen
// by the processor, or in a window by what draws there.
#pragma once

#include "render_client/viewer_options/viewer_options.h"

namespace bonemill {

// Runs for options.measure->time once the model is complete, or until a stop signal comes. Throws UserError
// (DDS domain, no display), GlError, and std::runtime_error when no model came in time.
void runMeasurement(const ClientOptions& options);

}  // namespace bonemill
