// haptic_server shows its clients everything through this, and hears what they ask of it: its topics of one
// session.
//
// The publisher thread owns it and alone calls its members, never the tick (a write can take milliseconds).
// No reader, however slow, gone or killed, blocks a write. Nothing is disposed when the publisher goes:
// clients keep the last picture. A restarted server is a new Publisher with a later epoch and replaces the
// model on every client.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "common/dds/endpoint.h"
#include "common/dds/node_digest.h"
#include "common/geometry/node_mesh.h"
#include "common/mesh_codec/mesh_codec.h"
#include "common/rt/clock.h"
#include "common/rt/latency_histogram.h"
#include "haptic_server/core/telemetry/tick_record.h"
#include "haptic_server/server/publish/command_inbox.h"
#include "haptic_server/server/publish/trainee_eye.h"
#include "proto/topics.pb.h"

namespace bonemill {

// Says how much may be written now, so that the mean stays below a rate. It is for one thread.
class ByteBudget {
  public:
    static constexpr double kBurst_s = 0.05;  // of saved-up allowance at most

    explicit ByteBudget(double bytes_per_s) : bytes_per_s_(bytes_per_s) {}

    // It is negative after more was spent than there was, for a whole group may be larger than what is left.
    int64_t available(int64_t now_ns) {
        if (last_ns_ != 0) allowance_ += bytes_per_s_ * secondsOfNs(now_ns - last_ns_);
        allowance_ = std::min(allowance_, bytes_per_s_ * kBurst_s);
        last_ns_ = now_ns;
        return int64_t(allowance_);
    }
    void spend(size_t bytes) { allowance_ -= double(bytes); }

  private:
    double bytes_per_s_;
    double allowance_ = 0;
    int64_t last_ns_ = 0;
};

struct PublisherOptions {
    uint32_t domain = 0;   // DDS domain, 0 to dds::kMaxDomain
    uint32_t session = 1;  // one server per session; clients name the same
    uint64_t epoch = 0;    // unix ns, later than that of any earlier server of the session; 0: now
    // Folder of --secure: its people are known by their certificates; empty: by their word.
    std::string secure = {};
};

class Publisher {
  public:
    // Throws UserError when the DDS domain cannot be joined.
    explicit Publisher(const PublisherOptions& options);

    // Begins another run, as a restarted server does, with a later epoch and an empty model: clients drop the
    // model that they have. The numbers of commands and batches go on, and so does who was answered what.
    void beginRun();

    struct Written {
        size_t bytes = 0;      // payloads of the nodes
        bool is_whole = true;  // false: DDS refused some, and the clients keep those older meshes
    };
    // Shows these nodes' surfaces together: clients wait for the last one, and an empty mesh removes its
    // node. A mesh is written once: one that is not newer (revision) than the last one of its leaf is
    // ignored. `oldest_cut_ns` is the start (CLOCK_MONOTONIC) of the oldest tick whose cut is new in them, or
    // 0 for none.
    Written publishNodes(std::span<const NodeMesh> meshes, int64_t oldest_cut_ns = 0);

    // The epoch is filled in.
    bool publishSceneInfo(topics::SceneInfo info);
    // The mesh's leaf is the structure (topics::StructureMesh).
    bool publishStructure(const NodeMesh& mesh, double warning_distance_m);
    // Tool states are best effort, for 60 to 100 calls per second; the time stamp is that of the call.
    // `effects` are the scene's, if it has such that say something.
    // `X_WT_expert` is where an expert's tool was, or another attempt's, if there is one to show.
    bool publishToolState(const TickRecord& record, std::optional<topics::EffectState> effects = {},
                          const std::optional<Pose>& X_WT_expert = {});
    // Somebody reads every tick: then publishTicks() is to be called some 100 times per second.
    bool areTicksRead() const { return ticks_writer_.matchedReaders() > 0; }
    // Writes them in messages of at most kMostTicks; what nobody reads is not written.
    void publishTicks(std::span<const TickRecord> records);
    static constexpr size_t kMostTicks = 64;
    // Epoch, node count, node digest and last command are filled in. Clients take a server for lost that
    // publishes nothing for 3 s: call at least once per second, and right after the last of a group of nodes.
    bool publishStatus(topics::Status status);

    // The epoch is filled in.
    bool publishLesson(topics::Lesson lesson);
    // The picture (PNG) of scene number `scene` of the lesson.
    bool publishScenePicture(uint32_t scene, const std::string& id, const std::string& png);

    // Shows it at this place, instead of what is there; the epoch is filled in.
    bool publishRemark(uint32_t place, topics::Remark remark);
    bool removeRemark(uint32_t place);

    // These commands have arrived, each valid and new; carry each out and acknowledge() it. What is invalid
    // is answered or counted here. With security their role and name are what the sender's certificate says.
    std::vector<topics::Command> takeCommands();
    // Says why it is believed who has sent it: "proven", "by its own word", "says gateway NAME".
    std::string proofOf(const topics::Command& command) const;
    // Returns what the trainee sees, if that is known and has changed since the last call.
    std::optional<SeenEye> takeEye();
    // Tells the sender, through Status at once, how the command ended.
    void acknowledge(const topics::Command& command, const Answer& answer);

    // Says how long the writes of nodes took in this run.
    const LatencyHistogram& writeTimes() const noexcept { return write_times_; }

    uint32_t session() const noexcept { return session_; }
    uint64_t epoch() const noexcept { return epoch_; }
    const dds::Participant& participant() const noexcept { return participant_; }
    const NodeDigest& digest() const noexcept { return digest_; }
    uint64_t malformedCommands() const noexcept { return inbox_.malformedCount(); }

  private:
    struct Node {
        uint32_t revision = 0;
        uint64_t content = 0;  // 0: it has no mesh now
        bool was_written = false;
    };
    bool isNewer(const NodeMesh& mesh) const;
    bool writeNode(const NodeMesh& mesh, const EncodedNode& encoded, size_t& bytes);
    bool removeNode(const NodeMesh& mesh);
    template <class Write>
    bool timed(Write&& write);
    bool writeStatus();
    void show(const CommandAcknowledgement& acknowledgement);
    // Returns false for a command whose sender is not known, or not the one that it says, where that counts.
    bool mayBeTaken(const std::optional<GuidPrefix>& participant, const dds::CommandSample& sample,
                    uint64_t writer);
    void tellOfForeign(const dds::CommandSample& sample, uint64_t writer);

    uint32_t session_;
    uint64_t epoch_;
    std::unordered_map<uint32_t, Node> nodes_;
    std::vector<uint32_t> structures_;  // written in this run
    std::set<uint32_t> remarks_;        // places with one
    NodeDigest digest_;
    uint64_t batch_ = 0;
    LatencyHistogram write_times_;
    topics::Status status_;  // as last published
    CommandInbox inbox_{[this](uint64_t writer) { return command_reader_.isMatched(writer); }};
    uint64_t foreign_commands_ = 0;
    TraineeEye trainee_eye_;
    std::optional<People> people_;                 // with security
    std::optional<ProvenSenders> proven_senders_;  // with security

    dds::Participant participant_;
    dds::Writer<dds::NodeMeshSample> node_writer_;
    dds::Writer<dds::SceneInfoSample> scene_info_writer_;
    dds::Writer<dds::StructureMeshSample> structure_writer_;
    dds::Writer<dds::ToolStateSample> tool_state_writer_;
    dds::Writer<dds::TicksSample> ticks_writer_;
    dds::Writer<dds::StatusSample> status_writer_;
    dds::Writer<dds::LessonSample> lesson_writer_;
    dds::Writer<dds::ScenePictureSample> picture_writer_;
    dds::Writer<dds::RemarkSample> remark_writer_;
    dds::Reader<dds::CommandSample> command_reader_;
    dds::Reader<dds::ViewerSample> viewer_reader_;
};

}  // namespace bonemill
