// It is the client's end of a session: what the server shows, kept up to date, and the way to
// send it commands.
//
// One thread (the render thread): poll() takes what has arrived. Bytes that do not make sense
// are dropped, counted, and at first named in the log; what comes with them arrives. A server that leaves
// changes nothing in the model; one that restarts replaces it, and a second one beside it does not.
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render_client/link/subscribe/density_feed.h"
#include "render_client/link/subscribe/session_ear.h"
#include "render_client/link/subscribe/viewer_voice.h"
#include "render_client/link/subscribe/wire.h"

namespace bonemill {

// The way of a viewer into a session: a DDS participant, or a gateway, with all that it writes, and the
// densities. It can be made anew, as if the viewer had been started again. For one thread.
struct SessionLink {
    // Says all as this sender and role; wishes of the hand are counted from `first_wish`. Goes through
    // `remote` where there is one, which must outlive the link. Throws UserError when the DDS domain cannot
    // be joined.
    SessionLink(uint32_t domain, RemoteSession* remote, uint32_t session, uint64_t sender,
                topics::Viewer::Role role, uint32_t first_wish)
        : participant(remote ? std::nullopt : std::make_optional<dds::Participant>(domain)),
          wire(remote ? Wire(*remote, session) : Wire(*participant)),
          viewer_writer(wire),
          hand(wire, session, sender, role, first_wish),
          density_feed(wire, session, sender),
          command_writer(wire) {}

    std::optional<dds::Participant> participant;
    const Wire wire;
    Outlet<dds::ViewerSample> viewer_writer;
    HandSpeaker hand;
    DensityFeed density_feed;
    Outlet<dds::CommandSample> command_writer;
};

struct SubscriberOptions {
    uint32_t domain = 0;    // DDS domain, 0 to dds::kMaxDomain
    uint32_t session = 1;   // that of the server
    std::string name = {};  // of who watches, for the others' lists
    topics::Viewer::Role role = topics::Viewer::OPERATOR;
    bool is_trainee = false;  // what this viewer sees is what the trainee sees
    // After so much silence it joins anew (Hearing).
    std::chrono::milliseconds rejoin_after = SilenceMonitor::kFirstSilence;
    // The gateway that the session is reached through; none: by DDS. Then name and role are the gateway's to
    // say.
    std::shared_ptr<RemoteSession> remote = {};
};

class SceneSubscriber : private SessionSink {
  public:
    static constexpr size_t kAllNodes = std::numeric_limits<size_t>::max();

    // Throws UserError when the DDS domain cannot be joined. Needs no server yet.
    explicit SceneSubscriber(const SubscriberOptions& options);

    // Takes and decodes what has arrived, at most `max_nodes` node samples (the rest stays for the next
    // call), sends the commands that are due, and returns the nodes that changed since the last call. Waits
    // for some milliseconds at most, for the rest of a batch of nodes that has begun to arrive.
    SceneModel::Changes poll(size_t max_nodes = kAllNodes);
    // Returns true when poll() has something to take, false when `timeout` passed before.
    bool waitForData(std::chrono::nanoseconds timeout) const;

    // These are the newest ones of the current server run; there is nothing before the first.
    const std::optional<topics::SceneInfo>& sceneInfo() const noexcept { return scene_info_; }
    // What its effects count since the state before, they count here since the poll() before.
    const std::optional<topics::ToolState>& toolState() const noexcept { return tool_state_; }
    const std::optional<topics::Status>& status() const noexcept { return ear_.status(); }
    // A server that shows another scene tells it anew. The pictures of its scenes come by and by.
    const std::optional<topics::Lesson>& lesson() const noexcept { return lesson_; }

    // What people of the current server run wrote and drew, by its place. The count changes with it.
    const std::map<uint32_t, topics::Remark>& remarks() const noexcept { return remarks_; }
    uint64_t remarkChanges() const noexcept { return remark_changes_; }

    // The protected structures of the current server run, by their number. The count changes with them;
    // structures with a larger one in StructureSurface::change came since.
    const std::map<uint32_t, StructureSurface>& structures() const noexcept { return structures_; }
    uint64_t structureChanges() const noexcept { return structure_changes_; }

    // Returns true when every node of the newest status is here, and no other. It is false in the short while
    // between a changed node and the status that counts it.
    bool isComplete() const { return ear_.isComplete(); }
    // Returns true when a server of this session was there at the last poll(): it was matched, and something
    // came from it within kServerTimeout.
    bool hasServer() const { return ear_.hasServer(); }
    static constexpr std::chrono::seconds kServerTimeout = SessionEar::kServerTimeout;
    // Returns true when the server that was heard last took its leave: it went while it was still heard. One
    // that crashed, or that the network lost, falls silent first.
    bool hasEnded() const { return ear_.hasEnded(); }
    // Returns what another server of this session calls its scene, while there is one: of two, the one that
    // was here first is shown for as long as it lives.
    std::optional<std::string> otherServer() const { return ear_.otherServer(); }

    uint64_t sender() const noexcept { return outbox_.sender(); }
    // Queues a command (sender, role and sequence are filled in) and returns its sequence; poll() sends it.
    uint32_t sendCommand(topics::Command command);
    // Returns how commands ended since the last call, acknowledged by the server or given up 5 s
    // after their turn came.
    std::vector<CommandOutcome> takeOutcomes() { return outbox_.takeOutcomes(); }

    // Tells all others who is watching here, where it points (m), whether its mouse holds the tool, and what
    // it sees, if that is for the recording: once per second at least.
    void announce(double frame_rate_hz, const std::optional<Eigen::Vector3d>& pointer_W,
                  bool is_holding = false, const std::optional<topics::Eye>& eye = std::nullopt);
    // Says where the mouse of this viewer wants the tool point: with every picture while it holds the tool.
    void wantTool(const Pose& X_WT, uint32_t buttons, uint32_t placements) {
        if (link_) link_->hand.want(X_WT, buttons, placements, epoch());
    }
    void letToolGo() {
        if (link_) link_->hand.letGo(epoch());
    }
    // Returns the other viewers of the session, heard within ViewerList::kTimeout, by sender.
    std::vector<topics::Viewer> viewers() const { return ear_.viewers().viewers(); }

    // Brings the densities that the store wants into it: after each poll(). The viewers of a store that wants
    // none pay nothing.
    void followDensities(DensityStore& densities);
    const DensityFeed& densityFeed() const noexcept { return link_->density_feed; }

    uint64_t epoch() const noexcept { return ear_.model().epoch(); }
    const NodeDigest& digest() const noexcept { return ear_.model().digest(); }
    uint64_t malformedSamples() const noexcept { return ear_.malformedSamples(); }
    // While it misses what a server tells without a pause it joins the domain anew, with a fresh participant:
    // a reader that became deaf hears again. Returns how often it did.
    uint64_t rejoinings() const noexcept { return rejoinings_; }

  private:
    void beginRun() override;
    void hear(const topics::Status& status) override { outbox_.acknowledge(status); }
    void hear(topics::SceneInfo&& info) override { scene_info_ = std::move(info); }
    void hear(topics::Lesson&& lesson) override;
    void hear(topics::ScenePicture&& picture, uint32_t scene) override;
    void hear(StructureSurface&& structure, const dds::StructureMeshSample& sample) override;
    void hear(topics::ToolState&& state) override { tool_state_ = std::move(state); }
    void hear(std::optional<topics::Remark>&& remark, uint32_t place) override;
    void sendCommands();
    void showPictures();
    void rejoinIfDeaf();

    SubscriberOptions options_;
    std::optional<topics::SceneInfo> scene_info_;
    std::optional<topics::ToolState> tool_state_;
    std::optional<topics::Lesson> lesson_;
    std::map<uint32_t, topics::ScenePicture> pictures_;  // of its scenes, by number
    std::map<uint32_t, topics::Remark> remarks_;
    uint64_t remark_changes_ = 0;
    std::map<uint32_t, StructureSurface> structures_;
    uint64_t structure_changes_ = 0;
    size_t structure_triangles_ = 0;
    uint64_t rejoinings_ = 0;
    uint32_t next_wish_ = 1;  // HandSpeaker
    CommandOutbox outbox_;

    std::unique_ptr<SessionLink> link_;  // none while joining anew fails
    SessionEar ear_;                     // on the link
};

}  // namespace bonemill
