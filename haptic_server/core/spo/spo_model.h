// Decides how the simulated tool (SPO) follows the hand and meets the bone: there is one interface for all
// contact laws. The scene chooses. All poses and wrenches are in V.
#pragma once

#include <cstdint>
#include <span>

#include "haptic_server/core/accuracy/accuracy_settings.h"
#include "haptic_server/core/contact/contact_weights.h"
#include "haptic_server/core/contact/point_shell.h"
#include "haptic_server/core/contact/surface_contact.h"
#include "haptic_server/core/spo/solve_energy.h"
#include "haptic_server/core/spo/spo_tool.h"

namespace bonemill {

// The tool meets this bone. All of it lives at least as long as the model.
struct SpoWorld {
    const VoxelVolume& volume;
    const LeafLattice& lattice;
    const PointShell& shell;
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
};

class SpoModel {
  public:
    virtual ~SpoModel() = default;
    // Does one tick of length dt: the tool is at X_VT, and the hand holds it at X_VT_device. It is RT-safe,
    // for the tick thread only.
    virtual SpoStep advance(const Pose& X_VT, const Pose& X_VT_device) noexcept = 0;
    // Forgets earlier ticks. It is called when the model becomes active.
    virtual void restart() noexcept = 0;
    // Takes effect with the next advance(). It is RT-safe, for the tick thread only.
    virtual void setAccuracy(const AccuracySettings& settings) noexcept = 0;
    // Gives another tool at the same pose; takes effect with the next advance(). It is RT-safe, for the
    // tick thread only.
    virtual void setTool(const SpoTool& tool) noexcept = 0;
    // Takes what effects add; null adds nothing. Only the gradient law has room for them.
    virtual void setEffects(ContactWeights*, SolveEnergy*) noexcept {}
    // Lists where the tool touches the bone at the end of the last advance(), as many as `out` has room for,
    // and returns how many. It is RT-safe, for the tick thread only.
    virtual size_t listContacts(std::span<SurfaceContact>) noexcept { return 0; }
};

// Returns the shell level of these settings: their factor's, or the first level if that was not built.
inline int levelOf(const PointShell& shell, const AccuracySettings& settings) noexcept {
    const int level = shell.levelOf(settings.shell_factor);
    return level < 0 ? 0 : level;
}

}  // namespace bonemill
