// Gravity draws a drop down on the bone's surface. The frame is V, the unit m. Any thread may
// call the functions.
#pragma once

#include "render_client/look/visual_effects/bone_surface.h"

namespace bonemill {

enum class Walk { kGoesOn, kRests, kFallsOff };

// Moves `at` along the surface by at most `distance`: less on level ground. Where the surface overhangs or
// ends the drop falls off, and `at` stays.
Walk walkDown(const BoneSurface& surface, const Eigen::Vector3f& up_V, float distance, SurfacePoint& at);

}  // namespace bonemill
