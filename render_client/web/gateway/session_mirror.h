// The session for guests, as its server shows it by DDS. For one thread; nothing waits.
#pragma once

#include <Eigen/Core>
#include <chrono>
#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "common/dds/endpoint.h"
#include "proto/gateway.pb.h"
#include "render_client/link/subscribe/session_ear.h"

namespace bonemill::gateway {

using Topic = Sample::Topic;
using Payload = std::shared_ptr<const std::string>;

// It names what is neither a node nor a brick: there are many of those.
struct SmallKey {
    Topic topic;
    uint64_t key = 0;
    auto operator<=>(const SmallKey&) const = default;
};

struct SharedNode {
    Payload payload;
    uint32_t revision = 0;
    Eigen::Vector3f place_V;  // m, a corner of the leaf
};

// The session as its server wrote it: of every topic the newest payload of every key. Whoever passes it on
// shares the payloads.
struct SessionState {
    uint64_t epoch = 0;  // of the server's run; 0: nothing has arrived yet
    std::map<SmallKey, Payload> small;
    std::unordered_map<uint32_t, SharedNode> nodes;
    std::optional<topics::ToolState> tool_state;
    std::optional<topics::Status> status;
    Eigen::Vector3f tool_V = Eigen::Vector3f::Zero();  // m
    bool has_server = false;
    bool has_ended = false;
};

// What is new since the look before.
struct SessionChanges {
    bool is_cleared = false;  // first forget everything: another run of the server began
    std::vector<SmallKey> small;
    std::vector<uint32_t> nodes;
    std::optional<topics::EffectState> counted;  // what happened in all tool states since
    bool has_tool_state = false;
    struct Brick {
        uint32_t number;
        Payload payload;
    };
    std::vector<Brick> bricks;

    bool isEmpty() const {
        return !is_cleared && small.empty() && nodes.empty() && !has_tool_state && bricks.empty();
    }
};

// Keeps a SessionState equal to what the session's server shows by DDS, as a viewer hears it
// (subscribe/session_ear.h).
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
