#include "common/geometry/node_mesh.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

constexpr float kOctahedralScale = 127;

float signNotZero(float value) noexcept {
    return value < 0 ? -1.0f : 1.0f;
}

// Folds the lower half of the octahedron outwards over the diagonals; it is its own inverse.
void fold(float& u, float& v) noexcept {
    const float folded_u = (1 - std::abs(v)) * signNotZero(u);
    v = (1 - std::abs(u)) * signNotZero(v);
    u = folded_u;
}

}  // namespace

OctahedralNormal encodeNormal(const Eigen::Vector3f& normal) noexcept {
    const float sum = normal.cwiseAbs().sum();
    float u = normal.x() / sum;
    float v = normal.y() / sum;
    if (normal.z() < 0) fold(u, v);
    // This rounds to nearest, because what is truncated is never negative.
    const auto rounded = [](float value) { return int8_t(int(value * kOctahedralScale + 128.5f) - 128); };
    return {rounded(u), rounded(v)};
}

Eigen::Vector3f decodeNormal(int8_t octahedral_u, int8_t octahedral_v) noexcept {
    float u = std::max(float(octahedral_u) / kOctahedralScale, -1.0f);
    float v = std::max(float(octahedral_v) / kOctahedralScale, -1.0f);
    const float z = 1 - std::abs(u) - std::abs(v);
    if (z < 0) fold(u, v);
    return Eigen::Vector3f(u, v, z).normalized();
}

}  // namespace bonemill
