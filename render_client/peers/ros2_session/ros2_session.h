// A session for nodes of ROS 2: what its server shows by DDS, said again in their messages and names
// (docs/howto/ros2.md). It orders nothing, and the server knows no more of it than of a viewer that looks.
// For one thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "common/dds/endpoint.h"
#include "common/ros/ros_domain.h"
#include "common/ros/ros_endpoint.h"
#include "render_client/link/subscribe/session_ear.h"
#include "render_client/peers/ros2_session/bone_markers.h"
#include "render_client/peers/ros2_session/said_events.h"
#include "render_client/peers/ros2_session/tick_speaker.h"

namespace bonemill::ros2 {

struct Ros2SessionOptions {
    uint32_t domain = 0;  // of the session
    uint32_t session = 1;
    std::string name_space = "bonemill";
    RosOptions ros = {};
    std::chrono::milliseconds rejoin_after = SilenceMonitor::kFirstSilence;
};

class Ros2Session : private SessionSink {
  public:
    // Throws UserError.
    explicit Ros2Session(const Ros2SessionOptions& options);

    // Takes what has come and says it again. Call it some hundred times per second, or when wait() is true.
    void step();
    // Returns true when there is something to take, false when `timeout` passed before.
    bool wait(std::chrono::nanoseconds timeout);

    uint64_t ticks() const noexcept { return ticks_; }
    uint64_t missingTicks() const noexcept { return speaker_.missing(); }

  private:
    using Clock = std::chrono::steady_clock;
    // What hears the session, and is made anew when it has become deaf.
    struct Link {
        explicit Link(uint32_t domain) : participant(domain), ticks(participant), wait_set(participant) {
            wait_set.add([this] { return ticks.handle(); });
        }

        dds::Participant participant;
        dds::Reader<dds::TicksSample> ticks;
        dds::WaitSet wait_set;
    };

    void beginRun() override;
    void hear(const topics::Status& status) override;
    void hear(topics::SceneInfo&& info) override;
    void hear(topics::Lesson&&) override {}
    void hear(topics::ScenePicture&&, uint32_t) override {}
    void hear(StructureSurface&&, const dds::StructureMeshSample&) override {}
    void hear(topics::ToolState&& state) override;
    void hear(std::optional<topics::Remark>&&, uint32_t) override {}

    void join();
    void rejoinIfDeaf();
    void takeTicks();
    void useArm();
    void sayFrames(const topics::ToolState& state);
    void sayOperatingState(const topics::ToolState& state);
    void sayEvents(const std::vector<std::string>& lines);
    void sayBone();

    const Ros2SessionOptions options_;
    std::optional<Link> link_;
    SessionEar ear_;
    std::optional<topics::SceneInfo> scene_info_;
    bool is_ares_ = false;  // the device

    dds::Participant ros_;
    TickSpeaker speaker_;
    Writer<TFMessage> tf_;
    Writer<OperatingState> operating_state_;
    Writer<String> events_, status_;
    Writer<MarkerArray> bone_;
    SaidEvents said_;
    BoneMarkers markers_;
    uint32_t bone_readers_ = 0;  // that ever were
    Clock::time_point bone_said_;
    uint64_t ticks_ = 0;
};

}  // namespace bonemill::ros2
