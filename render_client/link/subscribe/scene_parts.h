// Checks the parts of a scene file that come over the network, and reduces them to what a viewer uses. It is
// thread-safe and never throws (other than std::bad_alloc).
#pragma once

#include "proto/topics.pb.h"

namespace bonemill {

// This is as many as a scene may have: a vertex names one of them in one byte.
inline constexpr int kMostShownMaterials = 255;

// Returns true when every number in it, however deep, is finite and in its (range) of scene.proto.
bool isWithinRanges(const google::protobuf::Message& message);

// Forgets what is no viewer's business, so that nobody relies on it.
void keepShownParts(scene::Material& material);

}  // namespace bonemill
