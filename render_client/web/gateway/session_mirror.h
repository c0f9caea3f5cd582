// Keeps a SessionState equal to what the session's server shows by DDS, as a viewer hears it
// (subscribe/session_ear.h). For one thread; nothing waits.
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>

#include "common/dds/endpoint.h"
#include "render_client/link/subscribe/session_ear.h"
#include "render_client/web/gateway/session_state.h"

namespace bonemill::gateway {

class SessionMirror : private SessionSink {
  public:
    using Clock = SessionEar::Clock;

    // It has joined no domain yet.
    explicit SessionMirror(uint32_t session) : session_(session), ear_(session, *this) {}

    // Hears what comes there from now on, and keeps what it has. The participant must outlive the mirror, or
    // leave() comes before. Throws UserError.
    void join(const dds::Participant& participant);
    void leave();

    // Takes what has arrived, if a domain is joined.
    SessionChanges poll();
    // When our server was heard last.
    std::optional<Clock::time_point> lastHeard() const { return ear_.lastHeard(); }
    // The caller has slept for so long: silence in its sleep says nothing.
    void forgive(Clock::duration slept) { ear_.forgive(slept); }
    const SessionState& state() const noexcept { return state_; }
    // From now on bricks of the scan's densities are taken, too, or no longer.
    void hearBricks(bool should_hear);
    // The whole model of the newest status is here.
    bool isComplete() const { return ear_.isComplete(); }
    uint64_t malformedSamples() const noexcept { return ear_.malformedSamples(); }

  private:
    void beginRun() override;
    void hear(const topics::Status& status) override;
    void hear(topics::SceneInfo&& info) override;
    void hear(topics::Lesson&& lesson) override { keep(Sample::LESSON, 0, lesson.SerializeAsString()); }
    void hear(topics::ScenePicture&& picture, uint32_t scene) override {
        keep(Sample::SCENE_PICTURE, scene, picture.SerializeAsString());
    }
    void hear(StructureSurface&& structure, const dds::StructureMeshSample& sample) override;
    void hear(topics::ToolState&& state) override;
    void hear(std::optional<topics::Remark>&& remark, uint32_t place) override;
    void hear(const dds::NodeMeshSample& sample, const Eigen::Vector3f& origin_V) override;
    void hearViewers() override { has_heard_viewers_ = true; }
    void releaseNodes();
    void showViewers();
    void takeBricks();
    void keep(Topic topic, uint64_t key, std::string payload);
    void forget(Topic topic, uint64_t key);

    struct ArrivedNode {
        Payload payload;
        Eigen::Vector3f place_V;
    };

    const uint32_t session_;
    SessionState state_;
    SessionChanges changes_;
    std::map<std::pair<uint32_t, uint32_t>, ArrivedNode> arrived_;  // by leaf and revision, not shown yet
    Eigen::Vector3d p_WV_ = Eigen::Vector3d::Zero();
    Eigen::Quaterniond q_WV_ = Eigen::Quaterniond::Identity();
    bool has_heard_viewers_ = false;
    Clock::time_point listed_;                              // the viewers
    const dds::Participant* participant_ = nullptr;         // none: no domain is joined
    std::optional<Inlet<dds::DensityBrickSample>> bricks_;  // where they are wanted
    SessionEar ear_;
};

}  // namespace bonemill::gateway
