// A scene says this of a kind of bone or tissue, in SI.
#pragma once

#include <cstdint>
#include <vector>

namespace bonemill {

using MaterialId = uint8_t;  // 1 + index in the scene's list; 0: none
inline constexpr MaterialId kNoMaterial = 0;
inline constexpr int kMaxMaterials = 127;  // a vertex tells it in 7 bits

struct MaterialProperties {
    double stiffness_factor = 1;  // of the contact's stiffness per area
    double specific_energy = 0;   // J/m³ at any density; 0: not given, by density
    bool is_protected = false;
};

// The table is indexed by MaterialId; the first entry is for bone of no material. It is empty if the scene
// has no materials.
using MaterialTable = std::vector<MaterialProperties>;

}  // namespace bonemill
