#include "render_client/look/camera/view_settings.h"

namespace bonemill {

CutPlanes cutPlanes(const std::array<CutPlane, CutPlanes::kMax>& cuts, const Eigen::AlignedBox3d& bone_W) {
    CutPlanes result;
    if (bone_W.isEmpty()) return result;
    for (int axis = 0; axis < CutPlanes::kMax; ++axis) {
        const CutPlane& cut = cuts[size_t(axis)];
        if (!cut.is_on) continue;
        const double at = bone_W.min()[axis] + cut.position * bone_W.sizes()[axis];
        const double side = cut.is_flipped ? 1 : -1;
        Eigen::Vector4d plane = side * Eigen::Vector4d::Unit(axis);
        plane.w() = -side * at;
        result.planes[size_t(axis)] = plane.cast<float>();
        result.is_on[size_t(axis)] = true;
    }
    return result;
}

CutPlanes transformed(const CutPlanes& cuts_B, const Eigen::Matrix4f& X_AB) {
    CutPlanes cuts_A = cuts_B;
    const Eigen::Matrix3f R_AB = X_AB.topLeftCorner<3, 3>();
    const Eigen::Vector3f p_AB = X_AB.topRightCorner<3, 1>();
    for (Eigen::Vector4f& plane : cuts_A.planes) {
        const Eigen::Vector3f normal = R_AB * plane.head<3>();
        plane = {normal.x(), normal.y(), normal.z(), plane.w() - normal.dot(p_AB)};
    }
    return cuts_A;
}

}  // namespace bonemill
