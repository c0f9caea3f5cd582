// Changes single fields of a scene from outside its file: "coupling.max_speed_mm_per_s=80".
#pragma once

#include <string>

#include "proto/scene.pb.h"

namespace bonemill {

// `assignment` is PATH=VALUE: names of fields joined by dots, elements of lists as tool[0] (the next one
// after the last makes a new one), and the value as in a scene file; a text may go without its quotes.
// Messages on the way are made; a message itself is had by {}, with its defaults, and taken away by
// nothing after the sign, as "effects.thermal=". Throws UserError, which names the assignment, for unknown
// fields, values of another kind and what is not there to be taken away; ranges are checkScene()'s. It is for
// start-up only.
void setField(scene::Scene& scene, const std::string& assignment);

}  // namespace bonemill
