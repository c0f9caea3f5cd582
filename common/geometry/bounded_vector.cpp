#include "common/geometry/bounded_vector.h"

namespace bonemill {

bool limitLength(Eigen::Vector3d& v, double longest) noexcept {
    const double length = v.stableNorm();
    if (length <= longest) return false;
    v *= longest / length;
    return true;
}

Eigen::Vector3d bounded(Eigen::Vector3d v, double longest) noexcept {
    limitLength(v, longest);
    return v;
}

Wrench bounded(const Wrench& wrench, const WrenchNorms& norms) noexcept {
    return {bounded(wrench.force, norms.max_force), bounded(wrench.torque, norms.max_torque)};
}

}  // namespace bonemill
