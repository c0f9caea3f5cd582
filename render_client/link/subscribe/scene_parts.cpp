#include "render_client/link/subscribe/scene_parts.h"

namespace bonemill {

void keepShownParts(scene::Material& material) {
    scene::Material kept;
    kept.set_name(material.name());
    if (material.has_color()) kept.mutable_color()->Swap(material.mutable_color());
    kept.set_is_protected(material.is_protected());
    material.Swap(&kept);
    material.DiscardUnknownFields();
}

}  // namespace bonemill
