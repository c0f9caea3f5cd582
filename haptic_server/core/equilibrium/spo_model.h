// Decides how the simulated tool (SPO) follows the hand and meets the bone: there is one interface for all
// contact laws, and the tick knows no other. The scene chooses. All poses and wrenches are in V.
//
// All but construction is RT-safe and for the tick thread only. What is set takes effect with the next
// advance(). A law leaves out what means nothing to it.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "haptic_server/core/accuracy/accuracy_settings.h"
#include "haptic_server/core/contact/candidates.h"
#include "haptic_server/core/contact/contact_configs.h"
#include "haptic_server/core/contact/penalty_contact.h"
#include "haptic_server/core/contact/point_shell.h"
#include "haptic_server/core/coupling/energy_coupling.h"
#include "haptic_server/core/coupling/thesis_2012_coupling.h"
#include "haptic_server/core/tool/burr.h"
#include "haptic_server/core/tool/tool_model.h"

namespace bonemill {

// An SPO model needs to know this of the tool in use.
struct SpoTool {
    const ToolModel* model = nullptr;  // must outlive whoever uses the tool
    Burr burr = {};
    double saturation_force = 50;  // N: what the gradient law's coupling pulls this tool with at most
};

// Lets an effect add to the energy that the simulated tool's pose minimises.
class SolveEnergy {
  public:
    virtual ~SolveEnergy() = default;
    // Returns the energy at this pose of the tool. Within a tick it is one fixed function, bounded from
    // below, with a positive semi-definite stiffness. It is RT-safe, for the tick thread only.
    virtual EnergyTerm at(const Pose& X_VT) const noexcept = 0;
};

// The tool meets this bone. All of it lives at least as long as the model.
struct SpoWorld {
    const VoxelVolume& volume;
    const LeafLattice& lattice;
    const PointShell& shell;
};

// This holds the tool to the hand, in laws of either kind.
struct SpoCoupling {
    CouplingConfig thesis;
    EnergyCouplingConfig energy;
    double most_pull =
        std::numeric_limits<double>::infinity();  // N, of `energy`; less if the tool carries less
    // Of `energy`: the hand's place for the tool is so much farther from the tool than before, as seen from
    // there, that the pull stays what it was.
    double stretched = 1;
    std::optional<double> saturation_force = {};  // N, in place of the tool's own; none: that
};

// A law asks this of the tick around it.
struct SpoTraits {
    bool has_energy = false;           // SpoStep::stored_energy is all that it stores: an account can be kept
    bool wants_estimate = false;       // of the hand's pose between two steps of the encoders
    bool mills_voxel_centres = false;  // the burr takes a voxel whose centre it reaches; else it cuts finer
};

// It is the outcome of one tick, in V.
struct SpoStep {
    Pose X_VT;  // of the simulated tool after the tick
    // It acts on the hand about the tool point that it holds, before the limits of what it may feel.
    Wrench wrench_hand_V;
    // Contact and springs hold this after the tick, J; a law without an energy says 0.
    double stored_energy = 0;
    double effects_work = 0;  // J: that the effects' energies have done on the tool in this tick
    uint32_t contacts = 0;
    uint32_t candidates = 0;  // points that were tested in each iteration
    uint32_t iterations = 0;
    uint32_t gatherings = 0;     // of candidates
    double budget_share = 0;     // of the point tests that a tick may make, or of the room for points
    double max_penetration = 0;  // m
    // False says that no finite equilibrium was found: the tool is at its last good pose, the
    // wrench says nothing.
    bool is_solved = true;
    bool is_motion_clamped = false;  // a speed limit or the trust radius acted
    // Forces that can be felt are out of balance, and no step was found that helps.
    bool has_stalled = false;
    // There was no time for as many samples as the settings ask for.
    bool has_fewer_samples = false;
    // There were more points near the tool than there is room or time for: the solve was cut short.
    bool has_contact_overflow = false;
    // A tool that was chosen, or has bone around it of a sudden, where it has no room is still felt smaller
    // than it is.
    bool is_tool_growing = false;
};

class SpoModel {
  public:
    virtual ~SpoModel() = default;
    virtual SpoTraits traits() const noexcept { return {}; }
    // Does one tick of length dt: the tool is at X_VT, and the hand holds it at X_VT_device.
    virtual SpoStep advance(const Pose& X_VT, const Pose& X_VT_device) noexcept = 0;
    // Forgets earlier ticks. It is called when the model becomes active.
    virtual void restart() noexcept = 0;
    virtual void setAccuracy(const AccuracySettings& settings) noexcept = 0;
    // Gives another tool at the same pose.
    virtual void setTool(const SpoTool& tool) noexcept = 0;
    virtual void setCoupling(const SpoCoupling& coupling) noexcept = 0;
    // The bone is felt so stiff.
    virtual void setContact(const GradientContactConfig&) noexcept {}
    // Takes what effects add; null adds nothing.
    virtual void setEffects(ContactWeights*, SolveEnergy*) noexcept {}
    // The burr removes bone, or no longer does.
    virtual void setCutting(bool) noexcept {}
    // There is time for so many samples of the surface in a gathering.
    virtual void setAffordableSamples(size_t) noexcept {}
    // The bone is another one where the tool may be, and what it does to the tool is felt whole.
    virtual void expectOtherBone() noexcept {}
    // Lists where the tool touches the bone at the end of the last advance(), as many as `out` has room for,
    // and returns how many: mostCandidates() at most.
    virtual size_t listContacts(std::span<SurfaceContact>) noexcept { return 0; }
    // Points that effects may be asked about in a gathering.
    virtual size_t mostCandidates() const noexcept { return 0; }
};

// Returns the shell level of these settings: their factor's, or the first level if that was not built.
inline int levelOf(const PointShell& shell, const AccuracySettings& settings) noexcept {
    const int level = shell.levelOf(settings.shell_factor);
    return level < 0 ? 0 : level;
}

// One linear step towards the pose at which the contacts' wrench and the coupling's are in balance, damped
// and within the speed limits: what thesis_2012, vps and penalty_sdf share (Wan and McNeely 2003; Barbič and
// James 2008). It is RT-safe.
//
// Returns the pose after the step, and fills all of `out` but what the hand feels.
inline Pose quasiStaticStep(const ContactWrench& contact, const EnergyTerm& coupling,
                            const CouplingConfig& limits, const Pose& X_VT, double dt,
                            SpoStep& out) noexcept {
    const Matrix6d derivative = contact.derivative - coupling.stiffness;
    const EquilibriumStep solved = solveEquilibrium(limits, contact.wrench + coupling.wrench, derivative, dt);
    out.contacts = contact.contacts;
    out.iterations = 1;
    out.max_penetration = contact.max_depth;
    out.is_solved = solved.is_found;
    out.is_motion_clamped = solved.is_clamped;
    const Vector6d moved = (1 - limits.static_damping) * solved.step;
    return X_VT.incremented(moved.head<3>(), moved.tail<3>());
}

}  // namespace bonemill
