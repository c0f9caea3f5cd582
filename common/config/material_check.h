// Do the materials of a scene, and the effects that need them, agree?
#pragma once

#include <functional>
#include <string>

#include "proto/scene.pb.h"

namespace bonemill {

// It takes the path of a field and what is wrong with it, and throws.
using RefuseField = std::function<void(const std::string& path, const std::string& why)>;

void checkMaterials(const scene::Scene& scene, const RefuseField& refuse);

}  // namespace bonemill
