// Finds the tools of a scene. It is for start-up only.
#pragma once

#include <string>
#include <vector>

#include "proto/scene.pb.h"

namespace bonemill {

inline constexpr int kMaxTools = 16;

// There is at least one: a scene without tools has the default one. The pointers lead into `scene`.
std::vector<const scene::Tool*> toolsOf(const scene::Scene& scene);

// People call them so, in the same order: their names, else "tool 1", "tool 2", ... by place.
std::vector<std::string> toolNamesOf(const scene::Scene& scene);

// Finds the place of the tool that `text` means: its name, or its number from 1. Throws UserError, which says
// what there is, if there is none.
size_t toolIndexOf(const std::vector<std::string>& names, const std::string& text);

}  // namespace bonemill
