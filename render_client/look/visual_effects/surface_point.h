// It is a place on the bone's surface. The frame is V, the unit m.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace bonemill {

struct SurfacePoint {
    Eigen::Vector3f p_V = Eigen::Vector3f::Zero();
    Eigen::Vector3f n_V = Eigen::Vector3f::UnitZ();  // unit, out of the bone

    uint8_t material = 0;  // as NodeMesh::materials

    // Returns the height (m) of p above the tangent plane; it is negative in the bone.
    float heightOf(const Eigen::Vector3f& p) const { return n_V.dot(p - p_V); }
};

}  // namespace bonemill
