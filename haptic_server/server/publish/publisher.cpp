#include "haptic_server/server/publish/publisher.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <limits>
#include <utility>

#include "haptic_server/server/publish/other_server.h"

namespace bonemill {
namespace {

// A flood of commands must not keep the publisher thread from publishing.
constexpr size_t kMaxCommandsPerCall = 1024;
constexpr size_t kMaxViewersPerCall = 256;  // of announcements

int64_t unixTime_ns() {
    const auto since_epoch = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(since_epoch).count();
}

// From CLOCK_MONOTONIC to CLOCK_REALTIME. Of some looks the quickest counts: while this thread is put aside
// between the two clocks, they go on.
int64_t monotonicToUnix_ns() {
    int64_t best_ns = 0, quickest_ns = std::numeric_limits<int64_t>::max();
    for (int look = 0; look < 3; ++look) {
        const int64_t before_ns = monotonicNowNs(), unix_ns = unixTime_ns();
        const int64_t took_ns = monotonicNowNs() - before_ns;
        if (took_ns >= quickest_ns) continue;
        quickest_ns = took_ns;
        best_ns = unix_ns - before_ns - took_ns / 2;
    }
    return best_ns;
}

// The sample has its key already.
template <class Sample, class Message>
bool writeMessage(dds::Writer<Sample>& writer, Sample sample, const Message& message) {
    const std::string bytes = message.SerializeAsString();
    dds::setPayload(sample, bytes);
    return writer.write(sample);
}

template <class Sample, class Message>
bool writeMessage(dds::Writer<Sample>& writer, uint32_t session, const Message& message) {
    Sample sample{};
    sample.session = session;
    return writeMessage(writer, sample, message);
}

template <size_t N>
void assign(google::protobuf::RepeatedField<double>* field, const double (&values)[N]) {
    field->Assign(values, values + N);
}

topics::ToolState toolState(const TickRecord& record, uint64_t epoch) {
    topics::ToolState state;
    state.set_epoch(epoch);
    state.set_tick(record.tick);
    state.set_session_s(record.t_s);
    state.set_stamp_ns(unixTime_ns());
    assign(state.mutable_p_wt_m(), record.p_WT);
    assign(state.mutable_q_wt(), record.q_WT);
    assign(state.mutable_p_wt_device_m(), record.p_WT_device);
    assign(state.mutable_q_wt_device(), record.q_WT_device);
    assign(state.mutable_force_n(), record.f_hand_W);
    assign(state.mutable_torque_nm(), record.t_hand_W);
    state.set_contacts(record.contacts);
    state.set_max_penetration_m(record.max_penetration);
    state.set_buttons(record.buttons);
    state.set_waits_for_release(record.waits_for_release);
    state.set_device_state(record.device.state);
    state.set_stop_cause(record.device.stop_cause);
    return state;
}

// `to_unix_ns` leads from CLOCK_MONOTONIC to CLOCK_REALTIME.
void assign(const TickRecord& record, int64_t to_unix_ns, topics::Tick& tick) {
    tick.set_tick(record.tick);
    tick.set_stamp_ns(record.start_ns + to_unix_ns);
    assign(tick.mutable_p_wt_m(), record.p_WT);
    assign(tick.mutable_q_wt(), record.q_WT);
    assign(tick.mutable_p_wt_device_m(), record.p_WT_device);
    assign(tick.mutable_q_wt_device(), record.q_WT_device);
    assign(tick.mutable_force_n(), record.f_hand_W);
    assign(tick.mutable_torque_nm(), record.t_hand_W);
}

}  // namespace

Publisher::Publisher(const PublisherOptions& options)
    : session_(options.session),
      epoch_(options.epoch != 0 ? options.epoch : static_cast<uint64_t>(unixTime_ns())),
      participant_(options.domain),
      node_writer_(participant_),
      scene_info_writer_(participant_),
      structure_writer_(participant_),
      tool_state_writer_(participant_),
      ticks_writer_(participant_),
      status_writer_(participant_),
      lesson_writer_(participant_),
      picture_writer_(participant_),
      remark_writer_(participant_),
      command_reader_(participant_),
      viewer_reader_(participant_) {
    if (options.secure.empty()) return;
    people_.emplace(options.secure);
    proven_senders_.emplace([this](const GuidPrefix& prefix) { return people_->find(prefix); });
}

// Nodes, structures and remarks of the run before are removed for those who join later.
void Publisher::beginRun() {
    epoch_ = std::max(static_cast<uint64_t>(unixTime_ns()), epoch_ + 1);
    status_.clear_training();
    status_.clear_checkpoints();
    for (const auto& [leaf, node] : std::exchange(nodes_, {})) {
        if (node.content == 0) continue;
        dds::NodeMeshSample key{};
        key.session = session_;
        key.node = leaf;
        node_writer_.dispose(key);
    }
    for (const uint32_t structure : std::exchange(structures_, {})) {
        dds::StructureMeshSample key{};
        key.session = session_;
        key.structure = structure;
        structure_writer_.dispose(key);
    }
    while (!remarks_.empty()) removeRemark(*remarks_.begin());
    digest_ = NodeDigest();
    write_times_ = {};
}

bool Publisher::isNewer(const NodeMesh& mesh) const {
    const auto known = nodes_.find(mesh.leaf);
    return known == nodes_.end() || mesh.revision > known->second.revision;
}

// Removals come last: the surface that goes is hidden behind its neighbours' new one, and a hole
// would not be.
Publisher::Written Publisher::publishNodes(std::span<const NodeMesh> meshes, int64_t oldest_cut_ns) {
    const auto has_surface = [this](const NodeMesh& mesh) { return !mesh.isEmpty() && isNewer(mesh); };
    NodeTag tag{epoch_, ++batch_, uint32_t(std::ranges::count_if(meshes, has_surface)), 0};
    if (oldest_cut_ns != 0) tag.cut_stamp_ns = unixTime_ns() - (monotonicNowNs() - oldest_cut_ns);
    // Clients wait for the last of them: first all are coded, then all are written.
    std::vector<std::pair<const NodeMesh*, EncodedNode>> coded;
    for (const NodeMesh& mesh : meshes)
        if (has_surface(mesh)) coded.emplace_back(&mesh, encodeNodeMesh(mesh, tag));
    Written written;
    for (const auto& [mesh, encoded] : coded) written.is_whole &= writeNode(*mesh, encoded, written.bytes);
    for (const NodeMesh& mesh : meshes)
        if (mesh.isEmpty() && isNewer(mesh)) written.is_whole &= removeNode(mesh);
    return written;
}

template <class Write>
bool Publisher::timed(Write&& write) {
    const int64_t start_ns = monotonicNowNs();
    const bool is_written = write();
    write_times_.record(monotonicNowNs() - start_ns);
    return is_written;
}

bool Publisher::writeNode(const NodeMesh& mesh, const EncodedNode& encoded, size_t& bytes) {
    dds::NodeMeshSample sample{};
    sample.session = session_;
    sample.node = mesh.leaf;
    sample.revision = mesh.revision;
    dds::setPayload(sample, encoded.bytes);
    if (!timed([&] { return node_writer_.write(sample); })) return false;
    bytes += encoded.bytes.size();
    Node& node = nodes_[mesh.leaf];
    if (node.content != 0) digest_.remove(mesh.leaf, node.content);
    digest_.add(mesh.leaf, encoded.content);
    node = {mesh.revision, encoded.content, true};
    return true;
}

// A dispose is kept for every late joiner, so a node that never had a mesh gets none.
bool Publisher::removeNode(const NodeMesh& mesh) {
    Node& node = nodes_[mesh.leaf];
    dds::NodeMeshSample key{};
    key.session = session_;
    key.node = mesh.leaf;
    if (node.was_written && !timed([&] { return node_writer_.dispose(key); })) return false;
    if (node.content != 0) digest_.remove(mesh.leaf, node.content);
    node.revision = mesh.revision;
    node.content = 0;
    return true;
}

bool Publisher::publishSceneInfo(topics::SceneInfo info) {
    info.set_epoch(epoch_);
    return writeMessage(scene_info_writer_, session_, info);
}

bool Publisher::publishStructure(const NodeMesh& mesh, double warning_distance_m) {
    topics::StructureMesh structure;
    structure.set_epoch(epoch_);
    structure.set_surface(encodeNodeMesh(mesh, {.epoch = epoch_}).bytes);
    structure.set_warning_distance_m(warning_distance_m);
    dds::StructureMeshSample sample{};
    sample.session = session_;
    sample.structure = mesh.leaf;
    structures_.push_back(mesh.leaf);
    return writeMessage(structure_writer_, sample, structure);
}

bool Publisher::publishToolState(const TickRecord& record, std::optional<topics::EffectState> effects,
                                 const std::optional<Pose>& X_WT_expert) {
    topics::ToolState state = toolState(record, epoch_);
    if (effects) *state.mutable_effects() = std::move(*effects);
    if (X_WT_expert) {
        const Eigen::Vector3d& p = X_WT_expert->position;
        const Eigen::Quaterniond& q = X_WT_expert->rotation;
        state.mutable_p_wt_expert_m()->Assign(p.data(), p.data() + 3);
        for (const double part : {q.w(), q.x(), q.y(), q.z()}) state.add_q_wt_expert(part);
    }
    return writeMessage(tool_state_writer_, session_, state);
}

void Publisher::publishTicks(std::span<const TickRecord> records) {
    const int64_t to_unix_ns = monotonicToUnix_ns();
    while (!records.empty()) {
        const auto part = records.first(std::min(records.size(), kMostTicks));
        topics::Ticks ticks;
        ticks.set_epoch(epoch_);
        for (const TickRecord& record : part) assign(record, to_unix_ns, *ticks.add_ticks());
        writeMessage(ticks_writer_, session_, ticks);
        records = records.subspan(part.size());
    }
}

bool Publisher::publishStatus(topics::Status status) {
    status.set_last_command_sender(status_.last_command_sender());
    status.set_last_command_sequence(status_.last_command_sequence());
    status.set_last_command_result(status_.last_command_result());
    status.set_last_command_outcome(status_.last_command_outcome());
    status_ = std::move(status);
    return writeStatus();
}

bool Publisher::writeStatus() {
    status_.set_epoch(epoch_);
    status_.set_node_count(digest_.count());
    status_.set_node_digest(digest_.value());
    return writeMessage(status_writer_, session_, status_);
}

bool Publisher::publishLesson(topics::Lesson lesson) {
    lesson.set_epoch(epoch_);
    return writeMessage(lesson_writer_, session_, lesson);
}

bool Publisher::publishScenePicture(uint32_t scene, const std::string& id, const std::string& png) {
    topics::ScenePicture picture;
    picture.set_epoch(epoch_);
    picture.set_scene_id(id);
    picture.set_png(png);
    dds::ScenePictureSample sample{};
    sample.session = session_;
    sample.scene = scene;
    return writeMessage(picture_writer_, sample, picture);
}

bool Publisher::publishRemark(uint32_t place, topics::Remark remark) {
    remark.set_epoch(epoch_);
    dds::RemarkSample sample{};
    sample.session = session_;
    sample.place = place;
    remarks_.insert(place);
    return writeMessage(remark_writer_, sample, remark);
}

bool Publisher::removeRemark(uint32_t place) {
    if (remarks_.erase(place) == 0) return true;
    dds::RemarkSample key{};
    key.session = session_;
    key.place = place;
    return remark_writer_.dispose(key);
}

std::optional<SeenEye> Publisher::takeEye() {
    const TraineeEye::Clock::time_point now = TraineeEye::Clock::now();
    viewer_reader_.take(kMaxViewersPerCall,
                        [&](const dds::ViewerSample& sample, const dds::SampleInfo& info) {
                            if (!info.has_data || sample.session != session_) return;
                            std::optional<topics::Viewer::Role> proven;
                            if (people_) {
                                const auto owner = viewer_reader_.ownerOf(info.writer);
                                const auto identity = owner ? people_->find(*owner) : std::nullopt;
                                proven = identity ? roleOfIdentity(identity->role) : topics::Viewer::VIEWER;
                            }
                            trainee_eye_.hear(dds::payloadOf(sample), sample.sender,
                                              viewer_reader_.participantOf(info.writer), proven, now);
                        });
    return trainee_eye_.takeChanged(now);
}

std::vector<topics::Command> Publisher::takeCommands() {
    std::vector<topics::Command> commands;
    const uint64_t malformed_before = inbox_.malformedCount();
    std::unordered_map<uint64_t, uint64_t> participants;  // by writer: a flood comes of few
    const auto originOf = [&](uint64_t writer) {
        const auto [known, is_new] = participants.try_emplace(writer);
        if (is_new) known->second = command_reader_.participantOf(writer);
        return CommandOrigin{known->second, writer};
    };
    command_reader_.take(kMaxCommandsPerCall,
                         [&](const dds::CommandSample& sample, const dds::SampleInfo& info) {
                             if (!info.has_data || sample.session != session_) return;
                             const std::optional<GuidPrefix> participant =
                                 proven_senders_ ? command_reader_.ownerOf(info.writer) : std::nullopt;
                             if (!mayBeTaken(participant, sample, info.writer)) return;
                             CommandInbox::Decision decision =
                                 inbox_.receive(sample.sender, originOf(info.writer), dds::payloadOf(sample));
                             if (decision.is_foreign) tellOfForeign(sample, info.writer);
                             if (decision.acknowledgement) show(*decision.acknowledgement);
                             if (!decision.command) return;
                             if (participant) proven_senders_->identify(*decision.command, *participant);
                             commands.push_back(std::move(*decision.command));
                         });
    if (malformed_before == 0 && inbox_.malformedCount() > 0) {
        spdlog::warn("dropped a malformed command; more of them are only counted");
    }
    return commands;
}

bool Publisher::mayBeTaken(const std::optional<GuidPrefix>& participant, const dds::CommandSample& sample,
                           uint64_t writer) {
    if (!proven_senders_ || (participant && proven_senders_->mayUse(sample.sender, *participant)))
        return true;
    tellOfForeign(sample, writer);
    return false;
}

void Publisher::tellOfForeign(const dds::CommandSample& sample, uint64_t writer) {
    if (++foreign_commands_ > 1) return;
    const std::string host = command_reader_.hostOf(writer);
    spdlog::warn(
        "refused a command from {} with the sender number {} of somebody else; more of them are only counted",
        host.empty() ? "a PC without a name" : printableName(host), sample.sender);
}

std::string Publisher::proofOf(const topics::Command& command) const {
    return proven_senders_ ? proven_senders_->proofOf(command) : "by its own word";
}

void Publisher::acknowledge(const topics::Command& command, const Answer& answer) {
    show(inbox_.finish(command, answer));
}

void Publisher::show(const CommandAcknowledgement& acknowledgement) {
    status_.set_last_command_sender(acknowledgement.sender);
    status_.set_last_command_sequence(acknowledgement.sequence);
    status_.set_last_command_result(acknowledgement.answer.text);
    status_.set_last_command_outcome(acknowledgement.answer.outcome);
    writeStatus();
}

}  // namespace bonemill
