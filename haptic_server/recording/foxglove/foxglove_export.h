// A recorded session as Foxglove shows it (docs/howto/foxglove.md): every tick's poses and numbers, the
// frames, the bone by its changes, tool, structures, force, events and cuts, each on a topic of its own; and
// a layout that opens them. For one normal thread.
#pragma once

#include <optional>
#include <string>

#include "haptic_server/core/telemetry/tick_record.h"
#include "haptic_server/recording/foxglove/bone_topics.h"
#include "haptic_server/recording/foxglove/foxglove_file.h"
#include "haptic_server/recording/rerun/recording.h"
#include "haptic_server/recording/rerun/replay_events.h"
#include "haptic_server/scene/setup/scene_setup.h"
#include "proto/panels.pb.h"
#include "proto/plots.pb.h"

namespace bonemill {

// OUT.layout.json of OUT.mcap.
std::string layoutPathOf(const std::string& path);

class FoxgloveExport {
  public:
    // `simulation` has the bone whose ticks are run. References must outlive this object. Throws UserError,
    // as all that follows does, for a file that cannot be written.
    FoxgloveExport(const std::string& path, const Recording& recording, const scene::Scene& scene,
                   const SceneSetup& simulation);

    // Every tick in order, with when it started since the session's first one, and what happened up to it.
    void add(const TickRecord& record, int64_t session_ns, const ReplayEvents& events);
    void finish();

  private:
    // A message every so often of ticks that come.
    struct Pace {
        uint64_t ticks;
        bool isDue(uint64_t tick) const { return tick % ticks == 0; }
    };
    void begin();
    void putFrames(const TickRecord& record);
    void putNumbers(const TickRecord& record);
    void putForce(const TickRecord& record);
    void putTool(uint32_t tool);
    void putStructures();
    void addToCut(const TickRecord& record);
    void tellCut();
    void log(const std::string& text);
    uint16_t topic(const std::string& name, const google::protobuf::Descriptor& type) {
        return file_.addTopic(name, type);
    }

    std::string path_;
    const Recording& recording_;
    const scene::Scene& scene_;
    const SceneSetup& simulation_;
    FoxgloveFile file_;
    uint16_t tool_pose_, hand_pose_, tick_, frames_, force_, tool_, structures_, log_, cuts_;
    BoneTopics bone_;
    uint64_t first_stamp_ns_;  // of the session's first tick, since 1970
    Pace frames_pace_, force_pace_;
    uint64_t stamp_ns_ = 0;  // of the tick in hand
    bool has_begun_ = false, has_force_ = false;
    std::optional<uint32_t> shown_tool_;
    double removed_sum_mm3_ = 0;
    std::optional<plots::Cut> cut_;  // under way
};

}  // namespace bonemill
