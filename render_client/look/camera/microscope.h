// An operating microscope looks at the orbit's target from its side, but from its own working distance: what
// the orbit does by coming nearer, it does by magnifying.
//
// The frame is W, the unit is m. It is for any thread and never throws.
#pragma once

#include "render_client/look/camera/camera.h"

namespace bonemill {

// The picture has the same height at the target as the orbit's, so that pixels span the same lengths there.
Camera microscopeCamera(const Camera& orbit);

}  // namespace bonemill
