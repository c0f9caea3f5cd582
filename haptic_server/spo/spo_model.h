// How the simulated tool (SPO) follows the hand and meets the bone: one interface, two models. The scene
// chooses.
#pragma once

#include <cstdint>
#include <span>

#include "haptic_server/accuracy/accuracy_settings.h"
#include "haptic_server/contact/contact_weights.h"
#include "haptic_server/contact/point_shell.h"
#include "haptic_server/contact/surface_contact.h"
#include "haptic_server/spo/solve_energy.h"
#include "haptic_server/spo/spo_tool.h"

namespace bonemill {

// The bone that the tool meets; references to what lives at least as long as the model.
struct SpoWorld {
    const VoxelVolume& volume;
    const LeafLattice& lattice;
    const PointShell& shell;
};

struct SpoStep {
    Pose spo;            // after the tick, W
    Wrench wrench_hand;  // on the hand, axes W, about the tool point; not yet limited; of an unsolved tick
                         // nothing
    uint32_t contacts = 0;
    uint32_t candidates = 0;  // points that were tested in each iteration
    uint32_t iterations = 0;
    double budget_share = 0;         // of the point tests that a tick may make
    double max_penetration = 0;      // m
    bool is_solved = true;           // false: no finite equilibrium; the tool is at its last good pose
    bool is_motion_clamped = false;  // a speed limit or the trust radius acted
    bool has_stalled = false;  // forces that can be felt are out of balance, and no step was found that helps
    bool has_contact_overflow =
        false;  // more points near the tool than there is room or time for: the solve was cut short
};

class SpoModel {
  public:
    virtual ~SpoModel() = default;
    // One tick of length dt from `spo`. RT-safe; tick thread only.
    virtual SpoStep advance(const Pose& spo_W, const Pose& device_W) noexcept = 0;
    // Forgets what it remembers of earlier ticks; called when the tool is placed anew or the model becomes
    // active.
    virtual void restart() noexcept = 0;
    // Takes effect with the next advance(). RT-safe; tick thread only.
    virtual void setAccuracy(const AccuracySettings& settings) noexcept = 0;
    // Another tool at the same pose; takes effect with the next advance(). RT-safe; tick thread only.
    virtual void setTool(const SpoTool& tool) noexcept = 0;
    // What effects add; null: nothing. Only the gradient law has room for them.
    virtual void setEffects(ContactWeights*, SolveEnergy*) noexcept {}
    // Where the tool at the last advance()'s end touches the bone, as many as `out` has room for; returns how
    // many. RT-safe; tick thread only.
    virtual size_t listContacts(std::span<SurfaceContact>) noexcept { return 0; }
};

// The shell level of these settings: their factor's, or the first level if that was not built.
inline int levelOf(const PointShell& shell, const AccuracySettings& settings) noexcept {
    const int level = shell.levelOf(settings.shell_factor);
    return level < 0 ? 0 : level;
}

}  // namespace bonemill
