#include "device_daemon/ares/ares_device/gravity.h"

namespace bonemill {

Wrench holdingWrench(const MovingWeight& weight, const Pose& X_DT) noexcept {
    const Eigen::Vector3d force = -weight.mass * kStandardGravity * weight.down_D;
    return {force, (X_DT.rotation * weight.centre_T).cross(force)};
}

double potentialEnergy(const MovingWeight& weight, const Pose& X_DT) noexcept {
    return -weight.mass * kStandardGravity * weight.down_D.dot(X_DT * weight.centre_T);
}

}  // namespace bonemill
