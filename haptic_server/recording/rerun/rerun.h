// Runs the ticks of a recording again: with the same build, from its first tick on, they come to the same
// bits (docs/reference/recording.md). From a later one the bone is the same, and all else settles within a
// fraction of a second: what effects have counted and warmed up begins anew there.
//
// It belongs to one normal thread; the mesher may read the bone meanwhile.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "haptic_server/core/bone/bone_history.h"
#include "haptic_server/core/tick/haptic_tick.h"
#include "haptic_server/recording/rerun/recording.h"
#include "haptic_server/scene/setup/scene_setup.h"

namespace bonemill {

using RecordedCheckpoints = std::map<uint32_t, std::shared_ptr<const BoneSnapshot>>;

class Rerun {
  public:
    // All must outlive this object; `bone` is as scanned. Begins before the first tick, with `start`.
    Rerun(const Recording& recording, const SceneSetup& simulation, const RecordedCheckpoints& checkpoints,
          BoneModel& bone, const Keyframe& start);

    // The bone becomes that of the keyframe, whose tick is the next one.
    void startAt(const Keyframe& keyframe);

    // The tick that step() runs; end() at the end.
    uint64_t next() const noexcept { return next_; }
    uint64_t end() const noexcept { return recording_.ticks(); }
    bool isAtEnd() const noexcept { return next_ == end(); }
    // Runs the next tick, which there is. The record is good until the next call; its start_ns is now, and
    // its bone_order is the recording's.
    const TickRecord& step();
    // Leaves the recording: runs a tick with this hand instead, held by an engaged device, and with what the
    // switches below choose. What is in force stays so. From then on no tick of the recording is run.
    const TickRecord& step(const Pose& X_WT_hand, uint32_t buttons);
    // Leaves it, too, with all that this tick says; where that is what is recorded, to the same bits.
    const TickRecord& stepOtherwise(const JournalTick& tick);
    bool hasLeft() const noexcept { return has_left_; }
    // An order of the recording has put the bone back, or has begun to, in the last step.
    bool isBonePutBack() const noexcept { return is_put_back_; }

    BoneHistory& history() noexcept { return history_; }
    const BoneHistory& history() const noexcept { return history_; }
    // What is in force; no other object chooses.
    ToolSwitch& tools() noexcept { return tools_; }
    AccuracySwitch& accuracies() noexcept { return accuracy_; }

  private:
    void makeTick();
    void run(const DeviceInput& input);
    void run(JournalTick tick);
    void addTunings(const TunableScene& scene);
    uint32_t tuningOf(const TickDecisions& decisions) const;
    void choose(const TickDecisions& decisions);
    void putBack(const TickDecisions& decisions);

    const Recording& recording_;
    const RecordedCheckpoints& checkpoints_;
    const TickConfig& config_;
    BoneModel& bone_;
    BoneHistory history_;
    ToolSwitch tools_;
    AccuracySwitch accuracy_;
    TuningSwitch tunings_;
    std::map<uint32_t, uint32_t> tuning_numbers_;  // of tunings_, by the recording's
    RecordedTicks ticks_;
    std::unique_ptr<HapticTick> tick_;
    TickRecord record_{};
    uint64_t next_ = 0;
    uint64_t bone_order_ = 0;  // of the recording, given last
    uint64_t done_order_ = 0;  // of the recording, whose bone is there
    bool is_put_back_ = false;
    bool has_left_ = false;
    bool is_device_told_ = false;  // to tick_
};

// The bone of a recorded session at any moment, for who goes on from there: FILE@SECONDS, as --from
// takes it.
struct MomentName {
    std::filesystem::path journal;
    double seconds = 0;
};
// Throws UserError.
MomentName momentNameOf(const std::string& text);

struct RecordedMoment {
    journal::ResumedFrom from;
    std::shared_ptr<const BoneSnapshot> bone;
    uint32_t tool = 0, accuracy = 0;  // in force then
    scene::Tuning tuning;             // likewise
};

// Another bone like that of a fresh simulation of the scene.
BoneModel scannedCopyOf(const SceneSetup& simulation, const LoadedScene& scene);

// Runs the ticks up to there again, from the state of the bone before it. `simulation` is fresh, and stays
// so. Throws UserError if the recording is of another scene, or ends before.
RecordedMoment momentOf(const Recording& recording, const SceneSetup& simulation, const LoadedScene& scene,
                        double seconds);

}  // namespace bonemill
