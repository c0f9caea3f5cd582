// penalty_sdf: every contact point pushes in proportion to its depth in the other body's distance field,
// along its own normal; the tool stands where that and the coupling are in balance, found by one linear step
// a tick with the exact derivative of the contact wrench.
//
// After Barbič and James, "Six-DoF haptic rendering of contact between geometrically complex reduced
// deformable models", IEEE Transactions on Haptics 1(1), 2008, without deformation. The roles are exchanged:
// here the points are the bone's, whose shell follows the milling, and the field is the tool's, which never
// changes; a field of the bone would have to be made anew with every voxel. docs/explanation/laws.md has the
// equations.
#pragma once

#include <algorithm>

#include "haptic_server/laws/compared_law.h"
#include "haptic_server/laws/near_points.h"

namespace bonemill {

class PenaltySdf final : public ComparedLaw {
  public:
    static constexpr size_t kMaxPoints = 16384;  // in the tool

    PenaltySdf(const LawConfig& config, const SpoWorld& world, const SpoTool& tool, double dt)
        : ComparedLaw(config, world, tool, dt), points_(kMaxPoints) {}

    SpoStep advance(const Pose& X_VT, const Pose& X_VT_device) noexcept override {
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
    // The contacts at this pose, by the live bone; `has_room` is false if there were more than kMaxPoints.
    ContactWrench contactAt(const Pose& X_VT, bool& has_room) noexcept {
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

  private:
    NearPoints points_;
};

}  // namespace bonemill
