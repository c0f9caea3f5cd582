// The colours (sRGB, 0 to 1) that viewers are told for what a scene gives none: the zones of a task and the
// difference of two attempts. They are constants, for any thread.
#pragma once

#include <array>

#include "proto/scene.pb.h"

namespace bonemill {

using Srgb = std::array<double, 3>;

struct ZoneColour {
    scene::Task::Role role;
    Srgb colour;
};
inline constexpr ZoneColour kZoneColours[] = {{scene::Task::TARGET, {0.30, 0.72, 0.35}},
                                              {scene::Task::LEEWAY_SIDES, {0.95, 0.85, 0.25}},
                                              {scene::Task::LEEWAY_BOTTOM, {0.95, 0.65, 0.15}},
                                              {scene::Task::CONTAINER_SIDES, {0.90, 0.35, 0.15}},
                                              {scene::Task::CONTAINER_BOTTOM, {0.80, 0.12, 0.12}}};
inline constexpr Srgb kOtherZone{0.75, 0.20, 0.65};

// What was removed here alone, by the other alone, and by both: blue, orange and bluish green of Okabe and
// Ito, "Color Universal Design", 2008. The other tool's ghost is orange, too.
inline constexpr std::array<Srgb, 3> kDifferenceColours{{{0, 0.45, 0.70}, {0.90, 0.60, 0}, {0, 0.62, 0.45}}};

}  // namespace bonemill
