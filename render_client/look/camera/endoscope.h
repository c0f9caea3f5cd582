// This camera rides on the tool: beside the shaft it looks past the burr along the tool's axis (-y of T).
//
// The frames are W, the world, and T, the tool (docs/develop/frames.md); the units are m and rad. It is for
// any thread and never throws.
#pragma once

#include "common/geometry/pose.h"
#include "render_client/look/camera/camera.h"

namespace bonemill {

// The picture's up is T's +z; the burr stands below the middle of the picture.
Camera endoscopeCamera(const Pose& X_WT, double burr_radius);

}  // namespace bonemill
