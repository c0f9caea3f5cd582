// The gradient model's virtual coupling consists of springs between the simulated tool (SPO) and the device
// that follow from an energy, saturate smoothly, and damping against the SPO's pose one tick ago. All
// functions are RT-safe.
//
// With d from the SPO's grip point to the device's and θ = Log(q_dev q_spo⁻¹):
//   force  F_m tanh(k_t |d| / F_m) along d,   torque  T_m tanh(k_θ |θ| / T_m) along θ
// (Barbič and James 2008 for the saturation).
// Beside it there is a spring of k_2 about d_f, which follows d with the time constant τ_2 (a standard linear
// solid): it damps what is quicker than τ_2 and so makes up for the energy that sampling and delay give a
// stiff spring; a free tool, whose d does not change, is not held back by it. docs/explanation/stability.md
// says how much that is worth.
#pragma once

#include "common/base/units.h"
#include "common/geometry/pose.h"

namespace bonemill {

struct EnergyCouplingConfig {
    double translation_stiffness = 3000;  // k_t, N/m
    double rotation_stiffness = 0.5;      // k_θ, N·m/rad; the thesis' k_vcr is twice that at small angles
    double saturation_torque = 0.5 * 75 * kDegree;   // T_m, N·m: that of 75°
    double damping_time = 1e-3;                      // τ, s: how long the free tool takes to follow the hand
    double relaxing_share = 1;                       // k_2 / k_t
    double relaxing_time = 4e-3;                     // τ_2, s
    Eigen::Vector3d p_TG = Eigen::Vector3d::Zero();  // grip point G, where the force acts, in T
};

// The coupling of one tool: each may pull with another force at most.
struct EnergyCoupling : EnergyCouplingConfig {
    double saturation_force = 50;  // F_m, N
};

// It is an energy with its derivatives by the tool's world increment (x, ω); torques are about
// the tool point.
struct EnergyTerm {
    double energy = 0;                      // J
    Wrench wrench;                          // on the tool: minus the gradient of the energy
    Matrix6d stiffness = Matrix6d::Zero();  // positive semi-definite stand-in for its second derivative

    EnergyTerm& operator+=(const EnergyTerm& other) noexcept {
        energy += other.energy;
        wrench = wrench + other.wrench;
        stiffness += other.stiffness;
        return *this;
    }
};

// A rotation vector that does not jump where the shorter way round changes: of the two ways it takes the one
// that continues the last call's, up to kLongestWay; beyond, the shorter one.
class ContinuousRotation {
  public:
    static constexpr double kLongestWay = 4.5;  // rad, 258°

    // Returns the Log of the unit quaternion, of norm up to kLongestWay, without changing the memory.
    Eigen::Vector3d log(const Eigen::Quaterniond& rotation) const noexcept;
    // Remembers which way this one was taken.
    void remember(const Eigen::Quaterniond& rotation) noexcept;
    void forget() noexcept { last_ = Eigen::Quaterniond::Identity(); }

  private:
    Eigen::Quaterniond last_ = Eigen::Quaterniond::Identity();
};

// The springs go from the SPO to the device. Energies, wrenches and poses are in V here, as all in the tick.
EnergyTerm couplingEnergy(const EnergyCoupling& coupling, const Pose& X_VT, const Pose& X_VT_device,
                          const ContinuousRotation& way) noexcept;

// On the device, about the device's own tool point, acts minus the same energy's gradient by the device's
// pose, so that a closed path of the device costs no energy that the tool does not get.
Wrench couplingWrenchOnDevice(const EnergyCoupling& coupling, const Pose& X_VT, const Pose& X_VT_device,
                              const ContinuousRotation& way) noexcept;

// This is the spring of k_2; there is one object per tool.
class RelaxingSpring {
  public:
    RelaxingSpring(const EnergyCoupling& coupling, double dt) noexcept;

    // They are as couplingEnergy() and couplingWrenchOnDevice(), for this spring alone. Before the first
    // follow() it is slack.
    EnergyTerm energy(const Pose& X_VT, const Pose& X_VT_device) const noexcept;
    Wrench wrenchOnDevice(const Pose& X_VT, const Pose& X_VT_device) const noexcept;
    // End of a tick: d_f goes its way towards d.
    void follow(const Pose& X_VT, const Pose& X_VT_device) noexcept;
    void forget() noexcept { has_memory_ = false; }
    // The stretch that it follows stays.
    void setCoupling(const EnergyCoupling& coupling) noexcept;
    // That stretch is so many times as long from now on.
    void stretch(double times) noexcept { followed_ *= times; }

  private:
    Eigen::Vector3d stretchOf(const Pose& X_VT, const Pose& X_VT_device) const noexcept;

    EnergyCoupling coupling_;
    double dt_;
    double share_ = 0;                                    // of the way that d_f goes in a tick
    double stiffness_ = 0;                                // N/m against d_f before it follows
    Eigen::Vector3d followed_ = Eigen::Vector3d::Zero();  // d_f
    bool has_memory_ = false;
};

// Against motion from the pose at the tick's start: D/dt with D = τ diag(k_t, k_θ).
EnergyTerm dampingEnergy(const EnergyCouplingConfig& config, const Pose& X_VT, const Pose& X_VT_before,
                         double dt) noexcept;

}  // namespace bonemill
