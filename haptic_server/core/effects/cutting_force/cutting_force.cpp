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
#include "haptic_server/core/kernels/kernels.h"

namespace bonemill {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// It is the sum of dampers, each of which is a force −d (I − n nᵀ) v at r from the tool point against the
// motion v there. With w = (n, r × n) the twist's matrix is Σ d ([I, −r×; r×, −r×r×] − w wᵀ).
Matrix6d dampingOf(const RubbingSums& sums) noexcept {
    Matrix6d all;
    const Matrix3d r_skew = skew(Vector3d(sums.of_r));
    const double* s = sums.of_rr;
    const Matrix3d of_rr{{s[0], s[1], s[2]}, {s[1], s[3], s[4]}, {s[2], s[4], s[5]}};
    all.topLeftCorner<3, 3>() = sums.per_speed * Matrix3d::Identity();
    all.topRightCorner<3, 3>() = -r_skew;
    all.bottomLeftCorner<3, 3>() = r_skew;
    all.bottomRightCorner<3, 3>() = of_rr.trace() * Matrix3d::Identity() - of_rr;
    s = sums.of_ww;
    for (int row = 0; row < 6; ++row)
        for (int column = row; column < 6; ++column, ++s) {
            all(row, column) -= *s;
            if (column > row) all(column, row) -= *s;
        }
    return all;
}

// Contacts on the burr on their way into the sums.
class RubbingContacts {
  public:
    explicit RubbingContacts(const RubbingMotion& motion) noexcept : motion_(motion) {}
    RubbingContacts(const RubbingContacts&) = delete;  // points into itself
    RubbingContacts& operator=(const RubbingContacts&) = delete;

    // spread, m², and rho, m: see burr_speed.h.
    void add(const SurfaceContact& contact, double spread, double rho) noexcept {
        const int n = points_.count++;
        for (int axis = 0; axis < 3; ++axis)
            r_[axis][n] = contact.r_V[axis], normal_[axis][n] = contact.push_V[axis];
        force_[n] = contact.force, spread_[n] = spread, rho_[n] = rho;
        if (points_.count == kContactBatch) sum();
    }
    const RubbingSums& sums() noexcept {
        sum();
        return sums_;
    }

  private:
    void sum() noexcept {
        kernels().add_rubbing(motion_, points_, sums_);
        points_.count = 0;
    }

    RubbingMotion motion_;
    alignas(64) float r_[3][kContactBatch], normal_[3][kContactBatch], force_[kContactBatch];
    alignas(64) double spread_[kContactBatch], rho_[kContactBatch];
    RubbingPoints points_{r_[0], r_[1], r_[2], normal_[0], normal_[1], normal_[2], force_, spread_, rho_, 0};
    RubbingSums sums_;
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
        RubbingMotion motion{.spin = spin,
                             .friction = share * frictionOf(tick),
                             .slow_squared = config_.slow_speed * config_.slow_speed,
                             .held_per_moment = held_per_moment};
        const Vector3d axis_V = tick.axis();
        for (int axis = 0; axis < 3; ++axis) {
            motion.axis[axis] = axis_V[axis];
            motion.velocity[axis] = tick.velocity_V[axis];
            motion.angular_velocity[axis] = tick.angular_velocity_V[axis];
        }
        RubbingContacts contacts(motion);
        forEachBurrContact(tick, [&](const SurfaceContact& contact, const Vector3d&, double rho) {
            contacts.add(contact, patchSpread(double(tick.place_area[contact.candidate])), rho);
        });
        const RubbingSums& sums = contacts.sums();
        pull.of_spin = {Vector3d(sums.force), Vector3d(sums.torque)};
        pull.damping = dampingOf(sums);
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
