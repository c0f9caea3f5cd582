#include "render_client/link/subscribe/session_ear.h"

#include <spdlog/spdlog.h>

#include <thread>
#include <type_traits>
#include <utility>

namespace bonemill {
namespace {

// A topic keeps few samples per session, so more than this many at once is a flood of foreign sessions.
constexpr size_t kMaxSmallSamples = 256;
constexpr uint64_t kMaxNamed = 16;  // malformed samples in the log: a hostile peer must not fill it
constexpr std::chrono::seconds kReadAnewAgain{2};

uint64_t epochOf(const StructureSurface& structure) {
    return structure.epoch;
}
template <class Message>
uint64_t epochOf(const Message& message) {
    return message.epoch();
}

// None of the states between two looks is shown, so what happened in them is added up.
void addCounts(const topics::EffectState& before, topics::EffectState& now) {
    now.set_events(now.events() | before.events());
    now.set_removed_mm3(now.removed_mm3() + before.removed_mm3());
}

}  // namespace

SessionEar::Readers::Readers(const Wire& where)
    : wire(where), viewers(wire), servers(std::make_unique<ServerReaders>(wire, viewers)) {}

// Writers are others there than they were before.
void SessionEar::join(const Wire& wire) {
    readers_.emplace(wire);
    server_numbers_.clear();
    status_writer_ = 0;
    choice_.forgetRefused();
}

void SessionEar::leave() {
    readers_.reset();
    is_matched_ = false;
}

void SessionEar::poll(size_t max_nodes) {
    counted_.reset();
    if (readers_) {
        takeStatus();
        readAnewIfDue();
        takeScene();
        takeNodes(max_nodes);
        takeToolState();
        takeViewers();
        takeRemarks();
        noteEnd();
    }
    noteNothingToHear();
}

void SessionEar::takeRestOfBatch() {
    constexpr int kLooks = 12;
    constexpr std::chrono::microseconds kBetween{250};  // a node is written in some 100
    for (int n = 0; n < kLooks && readers_ && model_.isWaiting(); ++n) {
        std::this_thread::sleep_for(kBetween);
        takeNodes(std::numeric_limits<size_t>::max());
    }
}

// Hands on what `parse` makes of a sample, if our server wrote it.
template <class Sample, class Parse, class Use>
void SessionEar::take(Inlet<Sample>& inlet, const char* what, const Parse& parse, const Use& use) {
    inlet.take(kMaxSmallSamples, [&](const Sample& sample, const dds::SampleInfo& info) {
        if (!info.has_data || sample.session != session_) return;
        auto message = parse(sample);
        if (!message) return dropMalformed(what);
        if (accept(epochOf(*message), inlet, info.writer)) use(std::move(*message), sample);
    });
}

void SessionEar::takeStatus() {
    auto& inlet = readers_->servers->status;
    inlet.take(kMaxSmallSamples, [&](const dds::StatusSample& sample, const dds::SampleInfo& info) {
        if (!info.has_data || sample.session != session_) return;
        std::optional<topics::Status> status = parseStatus(dds::payloadOf(sample));
        if (!status) return dropMalformed("status");
        if (!accept(status->epoch(), inlet, info.writer)) {
            other_scene_ = status->scene();
            return;
        }
        status_writer_ = info.writer;
        sink_.hear(*status);
        status_ = std::move(status);
    });
}

void SessionEar::takeScene() {
    ServerReaders& servers = *readers_->servers;
    take(
        servers.scene_info, "scene info",
        [](const auto& sample) { return parseSceneInfo(dds::payloadOf(sample)); },
        [this](topics::SceneInfo&& info, const auto&) {
            if (scene_revision_ && info.revision() < *scene_revision_) return;
            scene_revision_ = info.revision();
            if (info.leaf_count() > 0) model_.setLeafCount(info.leaf_count());
            sink_.hear(std::move(info));
        });
    take(
        servers.lesson, "lesson", [](const auto& sample) { return parseLesson(dds::payloadOf(sample)); },
        [this](topics::Lesson&& lesson, const auto&) { sink_.hear(std::move(lesson)); });
    take(
        servers.pictures, "picture of a scene",
        [](const auto& sample) { return parseScenePicture(dds::payloadOf(sample), sample.scene); },
        [this](topics::ScenePicture&& picture, const auto& sample) {
            sink_.hear(std::move(picture), sample.scene);
        });
    take(
        servers.structures, "structure",
        [](const auto& sample) { return parseStructure(dds::payloadOf(sample), sample.structure); },
        [this](StructureSurface&& structure, const auto& sample) {
            sink_.hear(std::move(structure), sample);
        });
}

void SessionEar::takeToolState() {
    take(
        readers_->servers->tool_state, "tool state",
        [](const auto& sample) { return parseToolState(dds::payloadOf(sample)); },
        [this](topics::ToolState&& state, const auto&) {
            if (tick_ && state.tick() < *tick_) return;
            tick_ = state.tick();
            if (counted_ && state.has_effects()) addCounts(*counted_, *state.mutable_effects());
            if (state.has_effects()) counted_ = state.effects();
            sink_.hear(std::move(state));
        });
}

void SessionEar::takeNodes(size_t max_nodes) {
    auto& inlet = readers_->servers->nodes;
    inlet.take(max_nodes, [&](const dds::NodeMeshSample& sample, const dds::SampleInfo& info) {
        if (sample.session != session_) return;
        // Of a key that was written and then disposed only the older sample may be left, marked as disposed.
        if (info.is_disposed) {
            if (isOurs(inlet.participantOf(info.writer), info.writer)) model_.removeNode(sample.node);
            return;
        }
        if (!info.has_data) return;
        std::optional<DecodedNode> node = parseNode(dds::payloadOf(sample), sample.node, sample.revision);
        if (!node) return dropMalformed("node mesh " + std::to_string(sample.node));
        if (!accept(node->tag.epoch, inlet, info.writer)) return;
        const Eigen::Vector3f origin_V = node->mesh.origin;
        if (!model_.applyNode(std::move(*node), SceneModel::Clock::now()))
            return dropMalformed("node mesh " + std::to_string(sample.node) + ", which is one too many");
        sink_.hear(sample, origin_V);
    });
}

void SessionEar::takeRemarks() {
    auto& inlet = readers_->servers->remarks;
    inlet.take(kMaxSmallSamples, [&](const dds::RemarkSample& sample, const dds::SampleInfo& info) {
        if (sample.session != session_) return;
        if (info.is_disposed) {
            if (isOurs(inlet.participantOf(info.writer), info.writer)) sink_.hear(std::nullopt, sample.place);
            return;
        }
        if (!info.has_data) return;
        std::optional<topics::Remark> remark = parseRemark(dds::payloadOf(sample), sample.place);
        if (!remark) return dropMalformed("remark " + std::to_string(sample.place));
        if (accept(remark->epoch(), inlet, info.writer)) sink_.hear(std::move(remark), sample.place);
    });
}

void SessionEar::takeViewers() {
    const auto now = Clock::now();
    bool is_any_heard = false;
    auto& inlet = readers_->viewers;
    inlet.take(kMaxSmallSamples, [&](const dds::ViewerSample& sample, const dds::SampleInfo& info) {
        if (!info.has_data || sample.session != session_) return;
        if (own_sender_ != 0 && sample.sender == own_sender_) return;
        std::optional<topics::Viewer> viewer = parseViewer(dds::payloadOf(sample), sample.sender);
        if (!viewer) return dropMalformed("viewer " + std::to_string(sample.sender));
        viewers_.hear(std::move(*viewer), inlet.participantOf(info.writer), now);
        is_any_heard = true;
    });
    viewers_.forgetSilent(now);
    if (is_any_heard) sink_.hearViewers();
}

template <class Sample>
bool SessionEar::accept(uint64_t epoch, const Inlet<Sample>& inlet, uint64_t writer) {
    const auto now = Clock::now();
    const bool is_status = std::is_same_v<Sample, dds::StatusSample>;
    const ServerChoice::Message message{epoch, server_numbers_.of(inlet.participantOf(writer), writer),
                                        is_status};
    const bool was_ours = choice_.isOurs(message.server);
    if (choice_.judge(message, isServerAlive(), now) != ServerChoice::Verdict::kOurs) return false;
    if (!was_ours || epoch != model_.epoch()) beginRun();
    last_heard_ = now;
    hearing_.hear(Hearing::kServer, now);
    if (std::is_same_v<Sample, dds::ToolStateSample>) hearing_.hear(Hearing::kTool, now);
    if (std::is_same_v<Sample, dds::NodeMeshSample>) hearing_.hear(Hearing::kNodes, now);
    return true;
}

void SessionEar::beginRun() {
    model_.begin(choice_.epoch());
    status_.reset();
    status_writer_ = 0;
    tick_.reset();
    scene_revision_.reset();
    counted_.reset();
    sink_.beginRun();
}

// What was refused before it was known to be our server's is read anew, and so is what may be shown when ours
// is gone; the latter not again and again. DDS gives what was refused to new readers only.
void SessionEar::readAnewIfDue() {
    const auto now = Clock::now();
    const bool is_due = !read_anew_ || now - *read_anew_ > kReadAnewAgain;
    const bool has_candidate = is_due && choice_.hasCandidate() && !isServerAlive();
    if (!choice_.takeLost() && !has_candidate) return;
    if (has_candidate) read_anew_ = now;
    readers_->servers = std::make_unique<ServerReaders>(readers_->wire, readers_->viewers);
    choice_.forgetRefused();
}

bool SessionEar::isServerAlive() const {
    return isHeard() && (status_writer_ == 0 || readers_->servers->status.isMatched(status_writer_));
}

// It is the way to the gateway that is cut, whatever became of the server.
void SessionEar::noteEnd() {
    const RemoteSession* const remote = readers_->wire.remote;
    const bool was_matched = std::exchange(is_matched_, readers_->servers->status.matchedWriters() > 0);
    if (is_matched_)
        has_ended_ = false;
    else if (was_matched)
        has_ended_ = isHeard() && !(remote && remote->isCut());
}

// No server, no tick since the tool was heard, no node that is missing.
void SessionEar::noteNothingToHear() {
    const auto now = Clock::now();
    const bool is_alive = readers_ && isServerAlive() && status_;
    const uint64_t heard_ticks = tick_ ? *tick_ + 1 : 0;
    if (!is_alive || status_->ticks() <= heard_ticks) hearing_.hear(Hearing::kTool, now);
    if (!is_alive || isComplete()) hearing_.hear(Hearing::kNodes, now);
}

SessionEar::Clock::duration SessionEar::passTime() {
    const auto slept = hearing_.pass(Clock::now());
    forgive(slept);
    return slept;
}

bool SessionEar::isDeaf() {
    return hearing_.isDue(Clock::now());
}

std::optional<std::string> SessionEar::otherServer() const {
    return choice_.hasOther(Clock::now()) ? std::optional(other_scene_) : std::nullopt;
}

bool SessionEar::isComplete() const {
    return status_ && !status_->is_model_partial() && status_->node_count() == model_.digest().count() &&
           status_->node_digest() == model_.digest().value();
}

void SessionEar::dropMalformed(const std::string& what) {
    if (++malformed_count_ > kMaxNamed) return;
    spdlog::warn("dropped a malformed {}{}", what,
                 malformed_count_ == kMaxNamed ? "; from now on they are only counted" : "");
}

}  // namespace bonemill
