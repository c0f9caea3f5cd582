// The viewer off screen as fast as it can draw, without files: what it costs, as one JSON object on stdout.
#pragma once

#include "render_client/app/options.h"

namespace bonemill {

// For options.measure->time once the model is complete, or until a stop signal came. Throws UserError (DDS
// domain), GlError, and std::runtime_error when no model came in time.
void runMeasurement(const ClientOptions& options);

}  // namespace bonemill
