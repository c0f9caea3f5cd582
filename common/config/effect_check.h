// Do the effects of a scene agree with each other, with its tools and with its contact law?
#pragma once

#include "common/config/material_check.h"

namespace bonemill {

void checkEffects(const scene::Scene& scene, const RefuseField& refuse);

// It is the first listed effect, in the scene's order, that only the gradient law has room for; null: none.
const char* effectOfGradientLaw(const scene::Effects& effects);

}  // namespace bonemill
