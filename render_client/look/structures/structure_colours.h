// A structure is drawn in this colour. The functions are pure; any thread may call them.
#pragma once

#include <Eigen/Core>
#include <array>

#include "proto/topics.pb.h"

namespace bonemill {

// Returns the scene's colour of a material (sRGB, 0 to 1), or else what its name asks for by the custom of
// anatomy books: nerves yellow, veins blue, arteries red, dura violet. Others take their turn in a row of
// colours that people who see no red or no green can tell apart (Okabe and Ito 2008).
Eigen::Vector3f structureColour(const topics::SceneInfo& info, uint32_t structure);

// Returns the linear colour of an sRGB one, as the shaders' toneMap() takes it for, and back.
Eigen::Vector3f linearColour(const Eigen::Vector3f& srgb);
Eigen::Vector3f srgbColour(const Eigen::Vector3f& linear);

// These colours (linear) stand for distances from 0 to the reach. They run from dark red through orange and
// yellow to blue: bright and dark tell them apart without hues, too.
constexpr int kThicknessColours = 5;
const std::array<Eigen::Vector3f, kThicknessColours>& thicknessColours();

// The colour of a distance to a structure: red at 0, yellow at half of the warning distance, green from there
// on.
Eigen::Vector3f distanceColour(double distance, double warning_distance);

}  // namespace bonemill
