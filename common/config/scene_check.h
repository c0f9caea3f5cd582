// Are the values of a parsed scene allowed, each by itself and together? It is for start-up only.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "common/config/scene_text.h"

namespace bonemill {

// Throws UserError "name:line: field `path` = value ..." for the first value that is not finite, outside its
// (range), or in conflict with another field.
void checkScene(const ParsedScene& parsed, const std::string& name);

// Says what is wrong with a number in this field, by itself: "= 200 is outside 0 .. 100 (ms)"; empty if
// nothing is.
std::string numberProblem(const google::protobuf::FieldDescriptor& field, double value,
                          std::string_view unit);

// It takes the path of a field and what is wrong with it, and throws.
using RefuseField = std::function<void(const std::string& path, const std::string& why)>;

// Do the materials of a scene, and the effects that need them, agree?
void checkMaterials(const scene::Scene& scene, const RefuseField& refuse);

// Do the effects of a scene agree with each other, with its tools and with its contact law?
void checkEffects(const scene::Scene& scene, const RefuseField& refuse);
// It is the first listed effect, in the scene's order, that only the gradient law has room for; null: none.
const char* effectOfGradientLaw(const scene::Effects& effects);

// Does what a scene says of its task fit together? It knows how figures are named, and which zones and
// structures there are, but not which figures are measured.
void checkTask(const scene::Scene& scene, const RefuseField& refuse);
inline constexpr int kMaxZones = 32;
inline constexpr int kMaxTaskRules = 64;  // gates, and sub-scores

}  // namespace bonemill
