// Tells the effects of a scene that only its viewers show from those of the tick. Thread-safe.
#pragma once

#include <vector>

#include "proto/scene.pb.h"

namespace bonemill {

// `field`: of scene::Effects. By its number: the viewer's cost the tick nothing.
inline bool isViewerEffect(const google::protobuf::FieldDescriptor& field) {
    constexpr int kFirstViewerEffect = 20;  // as proto/scene.proto and CONTRIBUTING.md say
    return field.number() >= kFirstViewerEffect;
}

// Forgets the tick's effects, and fields that this program does not know.
inline void keepViewerEffects(scene::Effects& effects) {
    const google::protobuf::Reflection& reflection = *effects.GetReflection();
    std::vector<const google::protobuf::FieldDescriptor*> listed;
    reflection.ListFields(effects, &listed);
    for (const auto* field : listed)
        if (!isViewerEffect(*field)) reflection.ClearField(&effects, field);
    effects.DiscardUnknownFields();
}

}  // namespace bonemill
