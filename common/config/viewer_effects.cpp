#include "common/config/viewer_effects.h"

#include <vector>

namespace bonemill {
namespace {

constexpr int kFirstViewerEffect = 20;  // as proto/scene.proto and CONTRIBUTING.md say

}  // namespace

bool isViewerEffect(const google::protobuf::FieldDescriptor& field) {
    return field.number() >= kFirstViewerEffect;
}

void keepViewerEffects(scene::Effects& effects) {
    const google::protobuf::Reflection& reflection = *effects.GetReflection();
    std::vector<const google::protobuf::FieldDescriptor*> listed;
    reflection.ListFields(effects, &listed);
    for (const auto* field : listed)
        if (!isViewerEffect(*field)) reflection.ClearField(&effects, field);
    effects.DiscardUnknownFields();
}

}  // namespace bonemill
