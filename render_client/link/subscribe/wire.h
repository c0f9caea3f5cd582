// Where a viewer's samples come from and go to: a DDS participant, or a gateway. Inlets and outlets are used
// as dds::Reader and dds::Writer are.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "common/dds/endpoint.h"
#include "render_client/link/subscribe/remote_session.h"

namespace bonemill {

// What it names outlives whatever is made of it.
struct Wire {
    Wire(const dds::Participant& participant) : participant(&participant) {}
    Wire(RemoteSession& remote, uint32_t session) : remote(&remote), session(session) {}

    const dds::Participant* participant = nullptr;  // or else:
    RemoteSession* remote = nullptr;
    uint32_t session = 0;  // its samples have this number
};

// How the samples of a topic travel through a gateway.
struct RemoteTopic {
    using Topic = gateway::Sample;
    static constexpr auto of(const dds::NodeMeshSample&) { return Topic::NODE_MESH; }
    static constexpr auto of(const dds::SceneInfoSample&) { return Topic::SCENE_INFO; }
    static constexpr auto of(const dds::StructureMeshSample&) { return Topic::STRUCTURE_MESH; }
    static constexpr auto of(const dds::ToolStateSample&) { return Topic::TOOL_STATE; }
    static constexpr auto of(const dds::StatusSample&) { return Topic::STATUS; }
    static constexpr auto of(const dds::LessonSample&) { return Topic::LESSON; }
    static constexpr auto of(const dds::ScenePictureSample&) { return Topic::SCENE_PICTURE; }
    static constexpr auto of(const dds::RemarkSample&) { return Topic::REMARK; }
    static constexpr auto of(const dds::DensityBrickSample&) { return Topic::DENSITY_BRICK; }
    static constexpr auto of(const dds::ViewerSample&) { return Topic::VIEWER; }

    static auto* in(gateway::FromGuest& frame, const dds::ViewerSample&) { return frame.mutable_announce(); }
    static auto* in(gateway::FromGuest& frame, const dds::HandPointerSample&) { return frame.mutable_hand(); }
    static auto* in(gateway::FromGuest& frame, const dds::CommandSample&) { return frame.mutable_command(); }
    static auto* in(gateway::FromGuest& frame, const dds::DensityWishSample&) { return frame.mutable_wish(); }

    template <class Sample>
    static void setKey(Sample& sample, const gateway::Sample& from) {
        if constexpr (requires { sample.node; }) sample.node = uint32_t(from.key());
        if constexpr (requires { sample.revision; }) sample.revision = from.revision();
        if constexpr (requires { sample.structure; }) sample.structure = uint32_t(from.key());
        if constexpr (requires { sample.scene; }) sample.scene = uint32_t(from.key());
        if constexpr (requires { sample.place; }) sample.place = uint32_t(from.key());
        if constexpr (requires { sample.brick; }) sample.brick = uint32_t(from.key());
        if constexpr (requires { sample.sender; }) sample.sender = from.key();
    }
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
        for (; taken < max_samples && remote_->next(RemoteTopic::of(Sample{}), from); ++taken) {
            Sample sample{};
            sample.session = session_;
            RemoteTopic::setKey(sample, from);
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
        return RemoteTopic::in(frame, sample)->ParseFromArray(payload.data(), int(payload.size())) &&
               remote_->say(frame);
    }
    // Says these bytes as this sender.
    bool write(uint32_t session, uint64_t sender, const std::string& bytes) {
        Sample sample{};
        sample.session = session;
        sample.sender = sender;
        dds::setPayload(sample, bytes);
        return write(sample);
    }
    int matchedReaders() const { return writer_ ? writer_->matchedReaders() : remote_->hasServer(); }
    // A gateway answers for itself.
    bool isAllowed() const { return !writer_ || writer_->isAllowed(); }

  private:
    std::optional<dds::Writer<Sample>> writer_;
    RemoteSession* remote_;
};

}  // namespace bonemill
