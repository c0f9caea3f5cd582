// The publisher thread works with this: scene, tool, status and node meshes go to the clients, their commands
// to the tick.
#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <optional>

#include "common/base/units.h"
#include "common/log/log.h"
#include "haptic_server/scene/setup/scene_setup.h"
#include "haptic_server/server/publish/publisher.h"
#include "haptic_server/server/session/session_commands.h"
#include "haptic_server/server/session/shown_effects.h"
#include "haptic_server/server/session/surroundings_feed.h"
#include "haptic_server/server/session/tick_recorder.h"
#include "haptic_server/surface/density_stream/density_publisher.h"
#include "haptic_server/surface/mesh/mesh_outbox.h"
#include "haptic_server/teaching/lessons/scene_folder.h"

namespace bonemill {

class ShowSession {
  public:
    // Tells what the device can do; false says that none has told yet.
    using ShownDevice = std::function<bool(DeviceCapabilities&)>;

    // Node meshes and densities take at most `bytes_per_s`, the latter a part of what the former leave.
    // References must outlive this object.
    ShowSession(Publisher& publisher, const scene::Scene& scene, const SceneSetup& simulation,
                const BoneHistory& history, const AccuracyFigures& figures, MeshOutbox& outbox,
                Recorder& recorder, ShownDevice device, SessionCommands& commands, TaskMonitor& task,
                double bytes_per_s);

    // Publishes the scene, before the first round; the protected structures follow with some round().
    void begin();

    // The publisher thread makes a round, sleeps in awaitNodes() and rests for kPause: a round whenever nodes
    // have come, and about 200 times per second.
    static constexpr std::chrono::milliseconds kPause{1};
    void round();
    void awaitNodes() { outbox_.awaitPut(std::chrono::milliseconds(4)); }

    // Once the tick and the mesher have ended, whoever has joined the publisher thread publishes the nodes
    // that wait, until this instant (CLOCK_MONOTONIC) at most, and the status that counts them.
    void finish(int64_t until_ns);

    // Whoever has joined the publisher thread ends the attempt under way, and shows it, or leaves to the next
    // scene's what clients still wait for.
    void endAttempt();
    void leaveAnswers();

  private:
    bool publishNodes();
    std::vector<NodeMesh> takeStructures();
    void publishStructures();
    void publishDensities();
    void publishToolState(int64_t now_ns);
    std::optional<Pose> expertNow() const;
    void publishStatus();
    void publishSceneInfo();
    void publishLesson();
    void publishPictures();
    void publishRemarks();
    void carryOutCommands();
    void followTool();
    void answer(const topics::Command& command, const Answer& answer);
    void log(const topics::Command& command, const std::string& result);

    Publisher& publisher_;
    const scene::Scene& scene_;
    std::string scene_name_;
    MeshOutbox& outbox_;
    ByteBudget budget_, density_budget_;
    Pose X_VW_;
    bool is_whole_ = false;                          // all of the bone has been published
    double warning_distance_;                        // m, of structures
    std::future<std::vector<NodeMesh>> structures_;  // under way, on a thread of its own; then invalid
    Recorder& recorder_;
    ShownDevice device_;
    SessionCommands& commands_;
    TaskMonitor& task_;
    AccuracyFigures figures_;
    ShownEffects effects_;
    std::vector<std::string> material_names_;
    const std::vector<SceneTool>& tools_;
    DensitySource density_source_;
    DensityScale density_scale_;
    std::optional<DensityPublisher> densities_;  // since begin(), of that epoch
    topics::SceneInfo scene_info_;               // as last published
    std::optional<topics::Command> under_way_;   // an export that was begun and has not ended
    LogLimit orders_logged_{20, 3 * kNsPerSecond};
    size_t next_picture_ = 0;  // of the scenes of the lesson
    int64_t last_tool_state_ns_ = 0;
    int64_t last_status_ns_ = 0;
    bool has_changed_ = false;  // since the last status
    bool are_surroundings_shown_ = false;
    SurroundingsFeed surroundings_;
};

}  // namespace bonemill
