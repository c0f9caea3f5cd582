// Effects are what a scene adds to contact and coupling. Each effect is one small class; one that the
// scene does not list is not constructed. The host (effect_host.h) calls the hooks, each effect's in the
// order of effect_configs.h.
//
// In a tick: begin() → scale() at each gathering → energy() at each pose of the solve → addToHand() → the
// force goes out → mill() → finish(). All are RT-safe, for the tick thread only; construction allocates all
// that is ever needed.
#pragma once

#include <span>

#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/core/contact/candidates.h"
#include "haptic_server/core/coupling/energy_coupling.h"
#include "haptic_server/core/equilibrium/spo_model.h"
#include "haptic_server/core/milling/burr_limit.h"
#include "haptic_server/core/milling/milling_result.h"
#include "haptic_server/core/telemetry/effect_record.h"

namespace bonemill {

// This is what presses on the burr.
struct BurrLoad {
    double force = 0;   // N: Σ F
    double moment = 0;  // N·m: Σ F ρ; times frictionOf() against the spin, and times |Ω| the power
    size_t contacts = 0;
};

// This is known from the start of a tick on, in SI and axes V.
struct EffectStart {
    double dt = 1e-3;            // s: of all periods that the tick lives through
    int periods = 1;             // of the loop
    double milled_dt = 1e-3;     // s: of all periods for which the bone is milled in this tick: the last
    int milled_periods = 1;      // milling may have been put off
    int milling_thrift = 0;      // milling may work on its cells divided by 2 to this power
    bool may_mill = false;       // milling is neither paused nor stale
    bool is_pedal_down = false;  // and may mill
    bool is_add_wanted = false;  // the add button alone, likewise
    const SpoTool* tool = nullptr;
    MillingShape shape = MillingShape::kSubVoxel;  // that the contact law calls for
    Pose X_VT_start;
    Pose X_VT_milled;  // where the tool was when the bone was last milled; X_VT_start if that was not put off
};

// This is what effects see of the tick and tell each other, in SI and axes V unless the name says otherwise.
struct EffectTick : EffectStart {
    double spin_speed =
        0;  // rad/s about T's +y; without a spindle the full speed as soon as the pedal is down
    double axis_load = 0;  // N·m about T's +y: what the bone takes of the torque of a spindle

    // These are known after the solve.
    Pose X_VT;
    Eigen::Vector3d velocity_V = Eigen::Vector3d::Zero();          // of the tool point, m/s
    Eigen::Vector3d angular_velocity_V = Eigen::Vector3d::Zero();  // rad/s

    // These are known after the force went out, for effects that read contacts, and are kept until the
    // next tick's.
    std::span<const SurfaceContact> contacts;  // of the whole tool
    std::span<const uint8_t> is_on_burr;       // per contact
    std::span<const double> rubbing_radius;    // per contact on the burr: ρ, m (burr_speed.h)
    std::span<const float> place_area;         // per candidate: what it stands for, m²
    BurrLoad burr_load;                        // of the contacts on the burr
    double cut_share = 1;                      // of the burr's moment, that cuts; the rest rubs
    const Candidates* candidates = nullptr;    // of the last gathering

    bool has_time = true;  // at the end of the tick: else what nobody feels waits for the next one

    // It is made anew at the end of each tick (EffectHost::finish): zeros, spin, force and power of the burr,
    // then what each effect's finish() writes. Until then it is the last tick's.
    EffectRecord record{};

    Eigen::Vector3d axis() const noexcept { return X_VT_start.rotation * Eigen::Vector3d::UnitY(); }
};

// A contact of the tool that lies no farther outside of the burr than this, in m, still counts as the burr's.
inline double burrSlack(const ToolField& tool) noexcept {
    constexpr double kRim = 2e-6;  // m
    return kRim + 2 * tool.distanceError();
}

// Bone that is put back restarts the effects in every tick in which it is on its way: to the scan, or to
// (kBonePutBack) a checkpoint.
enum class Restart { kOtherTool, kOtherLaw, kBonePutBack, kScanPutBack };

class HapticEffect {
  public:
    // These say for what an effect needs to be called beside begin(), mill() and finish().
    enum Need : uint32_t {
        kScales = 1,         // scale()
        kHasEnergy = 2,      // energy()
        kReadsContacts = 4,  // EffectTick::contacts
    };
    explicit HapticEffect(uint32_t needs) noexcept : needs_(needs) {}
    virtual ~HapticEffect() = default;
    HapticEffect(const HapticEffect&) = delete;
    HapticEffect& operator=(const HapticEffect&) = delete;

    uint32_t needs() const noexcept { return needs_; }

    // Forgets what came before, the contacts above all; with kScanPutBack all that was done to the bone, and
    // finish() of the same tick notes nothing more of it.
    virtual void restart(Restart) noexcept {}
    virtual void begin(EffectTick&) noexcept {}
    // This is ContactWeights::scale() for one effect.
    virtual double scale(const EffectTick&, Candidates&, const Eigen::Vector3d& /*origin_V*/,
                         const ToolField&, const Pose& /*X_VT*/) noexcept {
        return 1;
    }
    // This is SolveEnergy::at() for one effect.
    virtual EnergyTerm energy(const EffectTick&, const Pose& /*X_VT*/) const noexcept { return {}; }
    // Changes what is on the hand about the tool point that it holds (contact, coupling and the effects
    // before this one), before the limits of what the hand may feel.
    virtual void addToHand(const EffectTick&, Wrench& /*wrench_V*/) noexcept {}
    // Changes the bone. This is not called while a snapshot is taken or the bone is put back.
    virtual void mill(EffectTick&, BoneModel&, MillingResult&) noexcept {}
    // This is called at the end of every tick, to write what the record says.
    virtual void finish(EffectTick&) noexcept {}

  private:
    uint32_t needs_;
};

}  // namespace bonemill
