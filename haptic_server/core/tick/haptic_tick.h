// A tick is one cycle of the haptic loop: read → pose → contact → solve → limit → write → mill → refresh
// shell → record. The effects of the scene act in between (effects/haptic_effect.h). The same tick
// runs behind the device link in real time, and in `simulate` without it.
//
// Inside there is one frame, V. What comes in is converted in acceptPose(), what goes out in write and
// record; SPO models, effects and limits know no other frame.
#pragma once

#include "haptic_server/core/bone/bone_history.h"
#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/core/effects/effect_host.h"
#include "haptic_server/core/equilibrium/spo_models.h"
#include "haptic_server/core/milling/milling_result.h"
#include "haptic_server/core/telemetry/tick_record.h"
#include "haptic_server/core/tick/hand_coupling.h"
#include "haptic_server/core/tick/hand_pose.h"
#include "haptic_server/core/tick/tick_budget.h"
#include "haptic_server/core/tick/tick_choices.h"
#include "haptic_server/core/tick/tick_config.h"
#include "haptic_server/core/tick/tick_io.h"
#include "haptic_server/core/tick/tick_tuning.h"

namespace bonemill {

// A tick changes this bone.
struct TickBone {
    BoneModel& model;
    BoneHistory* history = nullptr;  // null: nothing is ever put back or paused
};

// Others choose this while ticks go on.
struct TickChoices {
    const ToolSwitch& tools;
    const AccuracySwitch& accuracy;
    const TuningSwitch* tuning = nullptr;  // null: nothing is ever tuned
};

class HapticTick {
  public:
    HapticTick(const HapticTick&) = delete;
    HapticTick& operator=(const HapticTick&) = delete;
    // Keeps the references and allocates the scratch memory of contact and milling. From now on the bone's
    // shell follows the level of the settings in force.
    HapticTick(const TickConfig& config, const TickBone& bone, const TickChoices& choices);

    // Does one tick and returns what it did, good until the next one; null when io.read() said stop. RT-safe;
    // sets the RtScope guard around its work.
    const TickRecord* tick(TickIo& io) noexcept;

    // Returns the faults of all ticks so far (bits of TickFault). It is for the tick thread only.
    uint32_t latchedFaults() const noexcept { return latched_faults_; }
    // Returns the pose of the simulated tool after the last tick.
    Pose X_WT() const noexcept { return X_WV_ * X_VT_; }

  private:
    // This changes at one stroke what the hand feels.
    enum class SuddenChange : uint8_t { kHandJumps, kSettings, kTool, kBone, kPedal, kToolGrows };
    void noteSuddenChange(SuddenChange why) noexcept;
    void adaptTo(const DeviceCapabilities& device) noexcept;
    void keepAccount(const SpoStep& step, const DeviceInput& input) noexcept;
    void useCoupling() noexcept;
    void acceptPose(const DeviceInput& input, uint32_t& faults) noexcept;
    bool believe(const DeviceInput& input) noexcept;
    void placeTool() noexcept;
    bool isInBone(const Pose& X_VT, double radius) const noexcept;
    void decide(const DeviceInput& input) noexcept;
    void chooseSettings(SpoStep step, uint32_t& faults) noexcept;
    void takeUp(const AccuracySettings& settings) noexcept;
    void chooseTool() noexcept;
    void tune() noexcept;
    void beginEffects(const DeviceInput& input) noexcept;
    SpoStep moveAndFeel(const DeviceInput& input, uint32_t& faults) noexcept;
    MillingResult mill(const DeviceInput& input, TickIo& io, uint32_t& faults) noexcept;
    MillingResult millOrRestore(uint32_t& faults) noexcept;
    const EffectRecord& finishEffects(const DeviceInput& input, TickIo& io) noexcept;
    void capSamples(const DeviceInput& input, const TickLoad& load) noexcept;
    void keepWaiting(const SpoStep& step) noexcept;
    MillingResult millWithEffects(uint32_t& faults) noexcept;
    TickRecord makeRecord(const DeviceInput& input, const SpoStep& step) const noexcept;

    TickConfig config_;
    BoneModel& bone_;
    BoneHistory* history_;
    const ToolSwitch& tools_;
    const AccuracySwitch& accuracy_;
    const TuningSwitch* tunings_;
    uint32_t tuning_ = TuningSwitch::kOfScene;  // of *tunings_, in force
    size_t tool_;                               // of tools_
    TickDecisions decisions_;                   // for the tick under way
    uint32_t most_samples_ = 0;                 // in force; 0: no cap
    SpoModels models_;
    SpoModel* model_;  // of models_, in force
    AccuracySettings settings_;
    AffordablePreset affordable_preset_;
    AffordableShell affordable_;
    SampleCap sample_cap_;
    LaterWork later_work_;
    EffectHost effects_;
    HandLimits hand_limits_;
    HandCoupling hand_coupling_;
    HandEstimate estimate_;
    Pose X_WV_, X_VW_;
    Pose X_VT_device_;
    Pose X_VT_;
    HandPlace place_;
    uint32_t placements_ = 0;                               // of the hand, that were followed
    bool may_mill_ = false;                                 // in this tick
    bool was_pedal_down_ = false, was_add_wanted_ = false;  // in the last tick
    bool was_bone_taken_ = false;                           // likewise
    int unmilled_periods_ = 0;          // since the bone was last milled, where that was put off or refused
    Pose X_VT_milled_;                  // then
    bool waits_for_release_ = false;    // the bone was put back: it is not milled by a pedal that was down
    bool has_changed_suddenly_ = true;  // what the simulated side stores, by no work, since the last account
    TickRecord record_{};               // of the last tick
    uint64_t tick_ = 0;
    uint32_t latched_faults_ = 0;
};

}  // namespace bonemill
