// Tells people what a scene's task comes to on its bone.
#pragma once

#include <ostream>

#include "haptic_server/scene/setup/scene_setup.h"

namespace bonemill {

// Nothing for a scene without a task.
void describeTask(const Simulation& simulation, std::ostream& out);

}  // namespace bonemill
