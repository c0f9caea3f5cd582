// All contact laws: our own and those of other schools, for a tick that can choose any (TickConfig::laws).
#pragma once

#include "haptic_server/core/equilibrium/spo_models.h"

namespace bonemill {

// Any thread may call it.
std::span<const SpoLaw> allLaws();

}  // namespace bonemill
