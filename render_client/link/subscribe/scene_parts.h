// Reduces the parts of a scene file that come over the network to what a viewer uses. It is
// thread-safe and never throws (other than std::bad_alloc).
#pragma once

#include "proto/topics.pb.h"

namespace bonemill {

// This is as many as a scene may have: a vertex names one of them in one byte.
inline constexpr int kMaxShownMaterials = 255;

// Forgets what is no viewer's business, so that nobody relies on it.
void keepShownParts(scene::Material& material);

}  // namespace bonemill
