// Do the effects of a scene agree with each other, with its tools and with its contact law?
#pragma once

#include "common/config/material_check.h"

namespace bonemill {

void checkEffects(const scene::Scene& scene, const RefuseField& refuse);

// The first listed effect, as in the scene, that only the gradient law has room for; null: none.
const char* effectOfGradientLaw(const scene::Effects& effects);

}  // namespace bonemill
