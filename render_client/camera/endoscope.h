// A camera that rides on the tool: beside the shaft, looking past the burr along the tool's axis (-y of T).
//
// Frames: W world, T tool (docs/frames.md); m, rad. Any thread, never throws.
#pragma once

#include "common/geometry/pose.h"
#include "render_client/camera/camera.h"

namespace bonemill {

// The picture's up is T's +z; the burr stands below the middle of the picture.
Camera endoscopeCamera(const Pose& X_WT, double burr_radius);

}  // namespace bonemill
