// Hears a session: takes what servers and viewers say, checks it, and hands to a sink what comes from the one
// server that is shown (heard_peers.h). Viewers and gateways hear by it.
//
// One thread: poll() takes what has arrived and never waits. Bytes that do not make sense are dropped,
// counted, and at first named in the log; what comes with them arrives.
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "common/dds/endpoint.h"
#include "proto/topics.pb.h"
#include "render_client/link/subscribe/heard_peers.h"
#include "render_client/link/subscribe/payloads.h"
#include "render_client/link/subscribe/scene_model.h"
#include "render_client/link/subscribe/wire.h"

namespace bonemill {

// The readers of what servers write, which can be made anew: new readers get the newest sample of every key
// once more.
class ServerReaders {
  public:
    // Joins `also`, another reader, to the wait; it must outlive this object. Throws UserError.
    ServerReaders(const Wire& wire, const Inlet<dds::ViewerSample>& also)
        : nodes(wire),
          scene_info(wire),
          structures(wire),
          tool_state(wire),
          status(wire),
          lesson(wire),
          pictures(wire),
          remarks(wire),
          remote_(wire.remote) {
        if (remote_) return;
        wait_set_.emplace(*wire.participant);
        const auto watch = [this](const auto& reader) {
            wait_set_->add([&reader] { return reader.handle(); });
        };
        watch(nodes), watch(scene_info), watch(structures), watch(tool_state), watch(status), watch(lesson);
        watch(pictures), watch(remarks);
        watch(also);
    }

    // Returns true when something can be taken, false when `timeout` passed before.
    bool wait(std::chrono::nanoseconds timeout) {
        return remote_ ? remote_->wait(timeout) : wait_set_->wait(timeout);
    }

    Inlet<dds::NodeMeshSample> nodes;
    Inlet<dds::SceneInfoSample> scene_info;
    Inlet<dds::StructureMeshSample> structures;
    Inlet<dds::ToolStateSample> tool_state;
    Inlet<dds::StatusSample> status;
    Inlet<dds::LessonSample> lesson;
    Inlet<dds::ScenePictureSample> pictures;
    Inlet<dds::RemarkSample> remarks;

  private:
    RemoteSession* remote_;
    std::optional<dds::WaitSet> wait_set_;  // the last member: it waits for the others
};

// Is called from SessionEar::poll(). Of one kind the newest counts.
class SessionSink {
  public:
    // Another run of a server is shown from now on: what was heard before is over, but for the viewers.
    virtual void beginRun() = 0;
    virtual void hear(const topics::Status& status) = 0;
    virtual void hear(topics::SceneInfo&& info) = 0;
    virtual void hear(topics::Lesson&& lesson) = 0;
    virtual void hear(topics::ScenePicture&& picture, uint32_t scene) = 0;
    virtual void hear(StructureSurface&& structure, const dds::StructureMeshSample& sample) = 0;
    // Its effects count what happened since the poll() before.
    virtual void hear(topics::ToolState&& state) = 0;
    // No remark: the one of this place is gone.
    virtual void hear(std::optional<topics::Remark>&& remark, uint32_t place) = 0;
    // A node that the model has taken; `origin_V` is its mesh's.
    virtual void hear(const dds::NodeMeshSample&, const Eigen::Vector3f& /*origin_V*/) {}
    virtual void hearViewers() {}

  protected:
    ~SessionSink() = default;
};

class SessionEar {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds kServerTimeout{3};

    // Hears no viewer called `own_sender` (0: all). It has joined nothing yet.
    SessionEar(uint32_t session, SessionSink& sink, uint64_t own_sender = 0,
               std::chrono::milliseconds rejoin_after = SilenceMonitor::kFirstSilence)
        : session_(session), own_sender_(own_sender), sink_(sink), hearing_(rejoin_after) {}
    SessionEar(const SessionEar&) = delete;
    SessionEar& operator=(const SessionEar&) = delete;

    // Hears what comes from there from now on, and keeps what it has. What the wire names must outlive the
    // ear, or leave() comes before. Throws UserError.
    void join(const Wire& wire);
    void leave();

    // Takes what has arrived, at most `max_nodes` node samples; the rest stays for the next call.
    void poll(size_t max_nodes);
    // Takes the nodes that those which came belong with, and waits for them, but no longer than some
    // milliseconds: without them nothing of their batch is shown.
    void takeRestOfBatch();
    // Returns true when poll() has something to take, false when `timeout` passed before. It has joined.
    bool wait(std::chrono::nanoseconds timeout) const { return readers_->servers->wait(timeout); }

    // Silence in a sleep of the caller says nothing.
    void forgive(Clock::duration slept) {
        if (last_heard_) *last_heard_ += slept;
    }
    // Whether the domain is to be joined anew, and how long the caller has slept (Hearing).
    bool isDeaf();
    Clock::duration passTime();

    // The writer's participant as its reader knows it (dds::Reader::participantOf).
    bool isOurs(uint64_t participant, uint64_t writer) {
        return choice_.isOurs(server_numbers_.of(participant, writer));
    }
    // When our server was heard last.
    std::optional<Clock::time_point> lastHeard() const { return last_heard_; }
    // It was matched at the last poll(), and heard within kServerTimeout.
    bool hasServer() const { return is_matched_ && isHeard(); }
    // The server that was heard last went while it was still heard. One that crashed falls silent first.
    bool hasEnded() const { return has_ended_; }
    // What another server of this session calls its scene, while there is one.
    std::optional<std::string> otherServer() const;

    const std::optional<topics::Status>& status() const noexcept { return status_; }
    // Every node of the newest status is here, and no other.
    bool isComplete() const;
    SceneModel& model() noexcept { return model_; }
    const SceneModel& model() const noexcept { return model_; }
    const ViewerList& viewers() const noexcept { return viewers_; }

    void dropMalformed(const std::string& what);
    uint64_t malformedSamples() const noexcept { return malformed_count_; }

  private:
    struct Readers {
        explicit Readers(const Wire& wire);

        const Wire wire;
        Inlet<dds::ViewerSample> viewers;
        std::unique_ptr<ServerReaders> servers;
    };

    template <class Sample, class Parse, class Use>
    void take(Inlet<Sample>& inlet, const char* what, const Parse& parse, const Use& use);
    void takeStatus();
    void takeScene();
    void takeToolState();
    void takeNodes(size_t max_nodes);
    void takeRemarks();
    void takeViewers();
    // Returns whether a message of this epoch from this writer, as `inlet` knows it, is our server's.
    template <class Sample>
    bool accept(uint64_t epoch, const Inlet<Sample>& inlet, uint64_t writer);
    void beginRun();
    void readAnewIfDue();
    bool isHeard() const { return last_heard_ && Clock::now() - *last_heard_ < kServerTimeout; }
    bool isServerAlive() const;
    void noteEnd();
    void noteNothingToHear();

    const uint32_t session_;
    const uint64_t own_sender_;
    SessionSink& sink_;
    SceneModel model_;
    ServerChoice choice_;
    ServerNumbers server_numbers_;
    ViewerList viewers_;
    Hearing hearing_;
    // Of the run that is shown.
    std::optional<topics::Status> status_;
    uint64_t status_writer_ = 0;    // 0: not known yet
    std::optional<uint64_t> tick_;  // of the newest tool state
    std::optional<uint32_t> scene_revision_;
    std::optional<topics::EffectState> counted_;  // since the poll() before

    std::string other_scene_;  // what another server of the session shows
    std::optional<Clock::time_point> last_heard_, read_anew_;
    bool is_matched_ = false;  // with a server's writer, at the last poll()
    bool has_ended_ = false;
    uint64_t malformed_count_ = 0;
    std::optional<Readers> readers_;  // none: nothing is joined
};

}  // namespace bonemill
