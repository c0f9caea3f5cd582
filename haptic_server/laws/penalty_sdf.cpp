#include "haptic_server/laws/penalty_sdf.h"

#include <algorithm>

namespace bonemill {

ContactWrench PenaltySdf::contactAt(const Pose& X_VT, bool& has_room) noexcept {
    using Eigen::Matrix3d;
    using Eigen::Vector3d;
    has_room = points_.gather(world(), level(), field(), X_VT, 0);
    const Pose X_TV = X_VT.inverse();
    const double k = config().points.point_stiffness;
    ContactWrench sum;
    for (size_t i = 0; i < points_.count(); ++i) {
        const Vector3d b = points_.position(i);
        const ToolSample at = field().sample(X_TV * b);
        if (!(at.distance < 0)) continue;
        const Vector3d n = points_.normal(i), r = b - X_VT.position, g = X_VT.rotation * at.gradient;
        const Vector3d force = -k * at.distance * n;
        // Moving the tool by x changes the depth by g · x, turning it by ω by g · (ω × r) = (r × g) · ω.
        const Matrix3d F_x = k * n * g.transpose();
        const Matrix3d F_w = k * n * r.cross(g).transpose();
        const Matrix3d r_skew = skew(r);
        sum.wrench.force += force;
        sum.wrench.torque += r.cross(force);
        sum.derivative.topLeftCorner<3, 3>() += F_x;
        sum.derivative.topRightCorner<3, 3>() += F_w;
        sum.derivative.bottomLeftCorner<3, 3>() += r_skew * F_x + skew(force);
        sum.derivative.bottomRightCorner<3, 3>() += r_skew * F_w;
        ++sum.contacts;
        sum.max_depth = std::max(sum.max_depth, -at.distance);
    }
    return sum;
}

SpoStep PenaltySdf::advance(const Pose& X_VT, const Pose& X_VT_device) noexcept {
    SpoStep step;
    bool has_room = true;
    const ContactWrench contact = contactAt(X_VT, has_room);
    step.has_contact_overflow = !has_room;
    step.candidates = uint32_t(points_.count());
    step.budget_share = double(points_.count()) / kMaxPoints;
    const EnergyTerm pull = couplingEnergy(coupling(), X_VT, X_VT_device, way());
    const Pose X_VT_end = quasiStaticStep(contact, pull, config().steps, X_VT, dt(), step);
    feel(step, X_VT_end, X_VT_device);
    return step;
}

}  // namespace bonemill
