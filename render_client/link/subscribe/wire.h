// Where a viewer's samples come from and go to: a DDS participant, or a gateway. Inlets and outlets are used
// as dds::Reader and dds::Writer are.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "common/dds/endpoint.h"
#include "proto/gateway.pb.h"

namespace bonemill {

namespace gateway {
// What a guest's Hello says; render_client/web/page/src/link/session_socket.ts says the same.
inline constexpr uint32_t kProtocolVersion = 2;
}  // namespace gateway

// A session that a viewer reaches without DDS: what a gateway passes on (proto/gateway.proto). next() and
// wait() are for the thread that shows the session; the others for any.
class RemoteSession {
  public:
    virtual ~RemoteSession() = default;

    // Takes the next sample of this topic that has come; false: there is none.
    virtual bool next(gateway::Sample::Topic topic, gateway::Sample& sample) = 0;
    // Returns true when something can be taken, false when `timeout` passed before.
    virtual bool wait(std::chrono::nanoseconds timeout) = 0;
    // The gateway hears the session's server.
    virtual bool hasServer() const = 0;
    // The gateway itself is not reached.
    virtual bool isCut() const = 0;
    // Returns false while the gateway is not reached.
    virtual bool say(const gateway::FromGuest& message) = 0;
    // So the gateway is called: "wss://host:port".
    virtual std::string name() const = 0;
};

// What it names outlives whatever is made of it.
struct Wire {
    Wire(const dds::Participant& participant) : participant(&participant) {}
    Wire(RemoteSession& remote, uint32_t session) : remote(&remote), session(session) {}

    const dds::Participant* participant = nullptr;  // or else:
    RemoteSession* remote = nullptr;
    uint32_t session = 0;  // its samples have this number
};

// How the samples of a topic travel through a gateway.
template <class Sample>
struct RemoteTopic;
template <>
struct RemoteTopic<dds::NodeMeshSample> {
    static constexpr auto kTopic = gateway::Sample::NODE_MESH;
    static void setKey(dds::NodeMeshSample& sample, const gateway::Sample& from) {
        sample.node = uint32_t(from.key());
        sample.revision = from.revision();
    }
};
template <>
struct RemoteTopic<dds::SceneInfoSample> {
    static constexpr auto kTopic = gateway::Sample::SCENE_INFO;
    static void setKey(dds::SceneInfoSample&, const gateway::Sample&) {}
};
template <>
struct RemoteTopic<dds::StructureMeshSample> {
    static constexpr auto kTopic = gateway::Sample::STRUCTURE_MESH;
    static void setKey(dds::StructureMeshSample& sample, const gateway::Sample& from) {
        sample.structure = uint32_t(from.key());
    }
};
template <>
struct RemoteTopic<dds::ToolStateSample> {
    static constexpr auto kTopic = gateway::Sample::TOOL_STATE;
    static void setKey(dds::ToolStateSample&, const gateway::Sample&) {}
};
template <>
struct RemoteTopic<dds::StatusSample> {
    static constexpr auto kTopic = gateway::Sample::STATUS;
    static void setKey(dds::StatusSample&, const gateway::Sample&) {}
};
template <>
struct RemoteTopic<dds::LessonSample> {
    static constexpr auto kTopic = gateway::Sample::LESSON;
    static void setKey(dds::LessonSample&, const gateway::Sample&) {}
};
template <>
struct RemoteTopic<dds::ScenePictureSample> {
    static constexpr auto kTopic = gateway::Sample::SCENE_PICTURE;
    static void setKey(dds::ScenePictureSample& sample, const gateway::Sample& from) {
        sample.scene = uint32_t(from.key());
    }
};
template <>
struct RemoteTopic<dds::RemarkSample> {
    static constexpr auto kTopic = gateway::Sample::REMARK;
    static void setKey(dds::RemarkSample& sample, const gateway::Sample& from) {
        sample.place = uint32_t(from.key());
    }
};
template <>
struct RemoteTopic<dds::DensityBrickSample> {
    static constexpr auto kTopic = gateway::Sample::DENSITY_BRICK;
    static void setKey(dds::DensityBrickSample& sample, const gateway::Sample& from) {
        sample.brick = uint32_t(from.key());
    }
};
template <>
struct RemoteTopic<dds::ViewerSample> {
    static constexpr auto kTopic = gateway::Sample::VIEWER;
    static void setKey(dds::ViewerSample& sample, const gateway::Sample& from) { sample.sender = from.key(); }
    static auto* messageIn(gateway::FromGuest& frame) { return frame.mutable_announce(); }
};
template <>
struct RemoteTopic<dds::HandPointerSample> {
    static auto* messageIn(gateway::FromGuest& frame) { return frame.mutable_hand(); }
};
template <>
struct RemoteTopic<dds::CommandSample> {
    static auto* messageIn(gateway::FromGuest& frame) { return frame.mutable_command(); }
};
template <>
struct RemoteTopic<dds::DensityWishSample> {
    static auto* messageIn(gateway::FromGuest& frame) { return frame.mutable_wish(); }
};

template <class Sample>
class Inlet {
  public:
    // Throws UserError.
    explicit Inlet(const Wire& wire) : remote_(wire.remote), session_(wire.session) {
        if (wire.participant) reader_.emplace(*wire.participant);
    }

    template <class Handler>
    size_t take(size_t max_samples, Handler&& handle) {
        if (reader_) return reader_->take(max_samples, handle);
        gateway::Sample from;
        size_t taken = 0;
        for (; taken < max_samples && remote_->next(RemoteTopic<Sample>::kTopic, from); ++taken) {
            Sample sample{};
            sample.session = session_;
            RemoteTopic<Sample>::setKey(sample, from);
            const std::string& payload = from.payload();
            dds::setPayload(sample, payload);
            handle(sample, dds::SampleInfo{!payload.empty(), payload.empty(), kGateway});
        }
        return taken;
    }

    // 0 for a gateway's, which is waited for by itself.
    int32_t handle() const noexcept { return reader_ ? reader_->handle() : 0; }
    int matchedWriters() const { return reader_ ? reader_->matchedWriters() : remote_->hasServer(); }
    bool isMatched(uint64_t writer) const {
        return reader_ ? reader_->isMatched(writer) : remote_->hasServer();
    }
    uint64_t participantOf(uint64_t writer) const {
        return reader_ ? reader_->participantOf(writer) : kGateway;
    }

  private:
    static constexpr uint64_t kGateway = 1;  // writes all that comes through it

    std::optional<dds::Reader<Sample>> reader_;
    RemoteSession* remote_;
    uint32_t session_;
};

template <class Sample>
class Outlet {
  public:
    // Throws UserError.
    explicit Outlet(const Wire& wire) : remote_(wire.remote) {
        if (wire.participant) writer_.emplace(*wire.participant);
    }

    bool write(const Sample& sample) {
        if (writer_) return writer_->write(sample);
        const auto payload = dds::payloadOf(sample);
        gateway::FromGuest frame;
        return RemoteTopic<Sample>::messageIn(frame)->ParseFromArray(payload.data(), int(payload.size())) &&
               remote_->say(frame);
    }
    int matchedReaders() const { return writer_ ? writer_->matchedReaders() : remote_->hasServer(); }
    // A gateway answers for itself.
    bool isAllowed() const { return !writer_ || writer_->isAllowed(); }

  private:
    std::optional<dds::Writer<Sample>> writer_;
    RemoteSession* remote_;
};

}  // namespace bonemill
