// This is the tangential force with which bone holds on to the turning burr, and its torque about the burr's
// axis: the sixth degree of freedom. Each contact on the burr, of normal force F, rubs at the speed v_s = Ω a
// × r + v (v the tool's own motion there, tangential parts) and pulls with
//   F_t = −s μ F v_s / √(|v_s|² + v_ε²),   |v_s| the mean over its patch (burr_speed.h),
// so that about the axis M Ω = μ Σ F v_c · v_c / √(v_c² + v_ε²), v_c = |Ω| ρ. s fades from 1 to 0 as
// the burr comes to rest. What stands still sticks, and is surface_friction's; but a burr that a spindle
// cannot turn passes the motor's torque on, by forces in the direction of the spin in proportion to F:
//   F_t = −(1 − s) (L/Σ F ρ) F (a × r)/ρ,   L the spindle's axis_load.
//
// It comes from the last tick's contacts, smoothed with smoothing_time. In the solve it is a constant wrench
// for the spin, and for the tool's own motion a damper: force that follows a velocity of the last tick would
// shake a tool in a narrow place. It is RT-safe, for the tick thread only.
#include <cmath>

#include "haptic_server/core/effects/burr_speed.h"
#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/effects/haptic_effect.h"
#include "haptic_server/core/effects/increment.h"

namespace bonemill {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// It is the sum of dampers, each of which is a force −d (I − n nᵀ) v at r from the tool point against the
// motion v there. With w = (n, r × n) the twist's matrix is Σ d ([I, −r×; r×, −r×r×] − w wᵀ).
class TangentialDampers {
  public:
    void add(double d, const Vector3d& r, const Vector3d& n) noexcept {
        sum_ += d;
        of_r_ += d * r;
        of_rr_ += (d * r) * r.transpose();
        Vector6d w;
        w << n, r.cross(n);
        for (int column = 0; column < 6; ++column)
            of_w_.col(column).head(column + 1) += d * w[column] * w.head(column + 1);
    }
    Matrix6d damping() const noexcept {
        Matrix6d all;
        const Matrix3d r_skew = skew(of_r_);
        all.topLeftCorner<3, 3>() = sum_ * Matrix3d::Identity();
        all.topRightCorner<3, 3>() = -r_skew;
        all.bottomLeftCorner<3, 3>() = r_skew;
        all.bottomRightCorner<3, 3>() = of_rr_.trace() * Matrix3d::Identity() - of_rr_;
        return all - Matrix6d(of_w_.selfadjointView<Eigen::Upper>());
    }

  private:
    double sum_ = 0;
    Vector3d of_r_ = Vector3d::Zero();
    Matrix3d of_rr_ = Matrix3d::Zero();
    Matrix6d of_w_ = Matrix6d::Zero();  // the upper half
};

class CuttingForce final : public HapticEffect {
  public:
    explicit CuttingForce(const CuttingForceConfig& config) noexcept
        : HapticEffect(kReadsContacts | kHasEnergy), config_(config) {}

    void restart(Restart) noexcept override { pull_ = {}; }
    void begin(EffectTick& tick) noexcept override {
        const Pull now = pullOf(tick);
        const double way = tick.dt / (config_.smoothing_time + tick.dt);
        pull_.of_spin.force += way * (now.of_spin.force - pull_.of_spin.force);
        pull_.of_spin.torque += way * (now.of_spin.torque - pull_.of_spin.torque);
        pull_.damping += way * (now.damping - pull_.damping);
    }
    // It is bounded from below together with the solve's own damping.
    EnergyTerm energy(const EffectTick& tick, const Pose& X_VT) const noexcept override {
        const Increment step(tick.X_VT_start, X_VT);
        const Vector6d drag = pull_.damping * step.twist / tick.dt;
        EnergyTerm term;
        term.energy = -pull_.of_spin.force.dot(step.translation()) -
                      pull_.of_spin.torque.dot(step.rotation()) + drag.dot(step.twist) / 2;
        term.wrench =
            step.wrenchOf({pull_.of_spin.force - drag.head<3>(), pull_.of_spin.torque - drag.tail<3>()});
        term.stiffness = pull_.damping / tick.dt;
        return term;
    }
    void finish(EffectTick& tick) noexcept override {
        const double against = (tick.spin_speed != 0 ? tick.spin_speed : tick.axis_load) < 0 ? 1 : -1;
        const EnergyTerm at_end = energy(tick, tick.X_VT);
        tick.record.axis_torque = float(against * tick.axis().dot(at_end.wrench.torque));
    }

  private:
    // The pull acts on the tool, about the tool point, in V.
    struct Pull {
        Wrench of_spin;
        Matrix6d damping = Matrix6d::Zero();  // N·s/m, N·s, N·m·s: against the tool's own motion
    };
    Pull pullOf(const EffectTick& tick) const noexcept {
        Pull pull;
        const double spin = tick.spin_speed, share = spinShare(spin, tick.tool->burr);
        const double moment = tick.burr_load.moment;
        const double held_per_moment = moment > 0 ? (1 - share) * tick.axis_load / moment : 0;
        if (share == 0 && held_per_moment == 0) return pull;
        const Vector3d axis = tick.axis();
        const double friction = frictionOf(tick);
        TangentialDampers dampers;
        forEachBurrContact(tick, [&](const SurfaceContact& contact, const Vector3d& r, double rho) {
            const double spread = patchSpread(double(tick.place_area[contact.candidate]));
            const Vector3d n = contact.push_V.cast<double>();
            const Matrix3d tangential = Matrix3d::Identity() - n * n.transpose();
            const Vector3d by_turn = tangential * axis.cross(r), v_spin = spin * by_turn;
            const Vector3d v_tool = tangential * (tick.velocity_V + tick.angular_velocity_V.cross(r));
            const double mean_square = (v_spin + v_tool).squaredNorm() + spin * spin * spread;
            const double per_speed = share * friction * double(contact.force) /
                                     std::sqrt(mean_square + config_.slow_speed * config_.slow_speed);
            const double per_turn = per_speed * spin + held_per_moment * double(contact.force) / rho;
            const Vector3d force = -per_turn * by_turn;
            pull.of_spin.force += force;
            pull.of_spin.torque += r.cross(force) - per_turn * spread * axis;
            dampers.add(per_speed, r, n);
        });
        pull.damping = dampers.damping();
        return pull;
    }

    CuttingForceConfig config_;
    Pull pull_;
};

}  // namespace

std::unique_ptr<HapticEffect> CuttingForceConfig::make(const EffectNeeds&) const {
    return std::make_unique<CuttingForce>(*this);
}

}  // namespace bonemill
