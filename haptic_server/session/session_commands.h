// What clients may ask of a session, and what the session says of itself in return. Publisher thread only.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "haptic_server/bone/checkpoints.h"
#include "haptic_server/session/recorder.h"
#include "haptic_server/session/session_export.h"
#include "haptic_server/setup/scene_setup.h"
#include "haptic_server/tick/accuracy_switch.h"
#include "haptic_server/tick/tool_switch.h"
#include "proto/topics.pb.h"

namespace bonemill {

// What the commands act on: the tick takes each up by itself.
struct SessionControls {
    BoneHistory& history;
    AccuracySwitch& accuracy;
    ToolSwitch& tools;
    std::atomic<bool>& stop_requested;
    SessionExport& bone_export;
};

class SessionCommands {
  public:
    // References must outlive this object. `only_instructors`: others may only look.
    SessionCommands(const scene::Scene& scene, const BoneModel& bone, const Recorder& recorder,
                    const SessionControls& controls, bool only_instructors);

    // "done" or "refused: <why>"; nothing: it has begun, and its end comes with takeResult().
    std::optional<std::string> carryOut(const topics::Command& command);
    // Of the command that was begun, once it has ended: "done" or "failed: <why>".
    std::optional<std::string> takeResult() { return controls_.bone_export.takeResult(); }
    // Of the status: session clock, pause, checkpoints, what the bone has lost.
    void describe(topics::Status& status) const;
    const ToolSwitch& tools() const noexcept { return controls_.tools; }
    const AccuracySwitch& accuracy() const noexcept { return controls_.accuracy; }

  private:
    std::string refusalOf(const topics::Command& command) const;
    std::string setAccuracy(const std::string& name);
    std::string selectTool(uint32_t index);
    std::string restore(uint32_t checkpoint);
    double sessionS() const;

    SessionControls controls_;
    const Recorder& recorder_;
    Checkpoints checkpoints_;
    double voxel_mm3_;
    bool is_switchable_;
    const char* effect_of_gradient_law_;  // null: none
    bool only_instructors_;
};

}  // namespace bonemill
