// Clients may ask this of a session, and the session says this of itself in return. All members belong to
// the publisher thread.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "common/commands/answer.h"
#include "common/commands/role_rules.h"
#include "haptic_server/core/bone/checkpoints.h"
#include "haptic_server/core/tick/tick_choices.h"
#include "haptic_server/scene/setup/scene_accuracy.h"
#include "haptic_server/scene/setup/scene_setup.h"
#include "haptic_server/server/session/attempt_controller.h"
#include "haptic_server/server/session/journal_notes.h"
#include "haptic_server/server/session/scripted_hand.h"
#include "haptic_server/server/session/session_export.h"
#include "haptic_server/server/session/tick_recorder.h"
#include "haptic_server/server/session/tuning_desk.h"
#include "haptic_server/teaching/lessons/lesson_state.h"
#include "haptic_server/teaching/lessons/remark_list.h"
#include "proto/topics.pb.h"

namespace bonemill {

// Who shows a recorded session answers these instead of a live one (replay/player.h). The publisher thread
// calls all members; none waits.
class ReplayOrders {
  public:
    virtual ~ReplayOrders() = default;
    // Lets the recording go on, or holds it.
    virtual void play(bool goes_on) = 0;
    virtual Answer carryOut(const topics::ReplayOrder& order) = 0;
    // Fills in how the replay stands.
    virtual void describe(topics::Replay& replay) const = 0;
    // Adds materials and leaves of its own, behind those that are there. Once, before any other member.
    virtual void extend(topics::SceneInfo& info) = 0;
    // Where the tool of another attempt is, with which the recording is compared; nothing: it is not shown.
    virtual std::optional<Pose> otherTool() const = 0;
};

// The commands act on this; the tick takes each up by itself.
struct SessionControls {
    BoneHistory& history;
    AccuracySwitch& accuracy;
    ToolSwitch& tools;
    std::atomic<bool>& stop_requested;
    SessionExport& bone_export;
    std::atomic<uint32_t>& reset_orders;  // counts the orders to reset the device
    LessonState& lesson;
    AttemptController& attempts;
    OrderLimits& limits;
    JournalRecorder& journal;
    ScriptedHand& hand;
    ReplayOrders* replay = nullptr;  // there where a recording is shown
    TuningDesk* tuning = nullptr;    // there in a live session
};

class SessionCommands {
  public:
    // References must outlive this object. With `only_instructors` all others may only look.
    SessionCommands(const scene::Scene& scene, const BoneModel& bone, const Recorder& recorder,
                    const SessionControls& controls, bool only_instructors);

    // Nothing means that the command has begun, and its end comes with takeResult().
    std::optional<Answer> carryOut(const topics::Command& command);
    // This is how the command that was begun has ended, once it has.
    std::optional<Answer> takeResult() { return controls_.bone_export.takeResult(); }
    void waitForResult() { controls_.bone_export.wait(); }
    LessonState& lesson() noexcept { return controls_.lesson; }
    JournalRecorder& journal() noexcept { return controls_.journal; }
    Checkpoints& checkpoints() noexcept { return checkpoints_; }
    AttemptController& attempts() noexcept { return controls_.attempts; }
    RemarkList& remarks() noexcept { return remarks_; }
    // Null in a live session.
    ReplayOrders* replay() noexcept { return controls_.replay; }
    // Fills in the session clock, the pause, the checkpoints, what the bone has lost and, where the device is
    // described, how its script stands.
    void describe(topics::Status& status) const;
    const ToolSwitch& tools() const noexcept { return controls_.tools; }
    const AccuracySwitch& accuracy() const noexcept { return controls_.accuracy; }

  private:
    // Empty if it may be carried out.
    std::string whyNot(const topics::Command& command) const;
    std::optional<Answer> carryOutInReplay(const topics::Command& command);
    Answer setAccuracy(const std::string& name);
    Answer selectTool(uint32_t index);
    Answer beginAgain();
    Answer restore(uint32_t checkpoint);
    double sessionS() const;

    SessionControls controls_;
    const Recorder& recorder_;
    Checkpoints checkpoints_;
    RemarkList remarks_;
    double voxel_mm3_;
    PresetRule presets_;
    OpenTo open_to_;
};

}  // namespace bonemill
