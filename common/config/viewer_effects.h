// Tells the effects of a scene that only its viewers show from those of the tick. Thread-safe.
#pragma once

#include "proto/scene.pb.h"

namespace bonemill {

// `field`: of scene::Effects. By its number: the viewer's cost the tick nothing.
bool isViewerEffect(const google::protobuf::FieldDescriptor& field);

// Forgets the tick's effects, and fields that this program does not know.
void keepViewerEffects(scene::Effects& effects);

}  // namespace bonemill
