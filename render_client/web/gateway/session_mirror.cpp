#include "render_client/web/gateway/session_mirror.h"

#include <spdlog/spdlog.h>

#include <type_traits>
#include <utility>

#include "render_client/link/subscribe/density_payloads.h"
#include "render_client/link/subscribe/payloads.h"
#include "render_client/link/subscribe/scene_subscriber.h"

namespace bonemill::gateway {
namespace {

constexpr size_t kMostSmallSamples = 256, kMostNodes = 512, kMostBricks = 256;  // per look
constexpr std::chrono::milliseconds kListEvery{500};
constexpr std::chrono::seconds kReadAnewAgain{2};
constexpr uint64_t kMostNamed = 16;  // malformed samples in the log

std::string bytesOf(std::span<const uint8_t> payload) {
    return {reinterpret_cast<const char*>(payload.data()), payload.size()};
}

}  // namespace

SessionMirror::Ears::Ears(const dds::Participant& p)
    : participant(p), viewers(p), servers(std::make_unique<ServerReaders>(p, viewers)) {}

void SessionMirror::Ears::readAnew() {
    servers = std::make_unique<ServerReaders>(participant, viewers);
}

// Writers are others there than they were before.
void SessionMirror::join(const dds::Participant& participant) {
    ears_.emplace(participant);
    server_numbers_.clear();
    status_writer_ = 0;
    choice_.forgetRefused();
}

void SessionMirror::leave() {
    ears_.reset();
    is_matched_ = false;
}

SessionChanges SessionMirror::poll() {
    if (ears_) takeAll();
    releaseNodes();
    state_.has_server = is_matched_ && isHeard();
    return std::exchange(changes_, {});
}

void SessionMirror::takeAll() {
    takeStatus();
    readAnewIfDue();
    takeSceneInfo();
    takeLesson();
    takePictures();
    takeStructures();
    takeNodes();
    takeToolState();
    takeViewers();
    takeRemarks();
    takeBricks();
    noteEnd();
}

bool SessionMirror::isComplete() const {
    return state_.status && !state_.status->is_model_partial() &&
           state_.status->node_count() == model_.digest().count() &&
           state_.status->node_digest() == model_.digest().value();
}

void SessionMirror::hearBricks(bool should_hear) {
    if (!ears_) return;
    if (!should_hear)
        ears_->bricks.reset();
    else if (!ears_->bricks)
        ears_->bricks.emplace(ears_->participant);
}

void SessionMirror::keep(Topic topic, uint64_t key, std::string payload) {
    state_.small[{topic, key}] = std::make_shared<const std::string>(std::move(payload));
    changes_.small.push_back({topic, key});
}

void SessionMirror::forget(Topic topic, uint64_t key) {
    if (state_.small.erase({topic, key}) > 0) changes_.small.push_back({topic, key});
}

void SessionMirror::takeStatus() {
    ears_->servers->status.take(
        kMostSmallSamples, [this](const dds::StatusSample& sample, const dds::SampleInfo& info) {
            if (!info.has_data || sample.session != session_) return;
            std::optional<topics::Status> status = parseStatus(dds::payloadOf(sample));
            if (!status) return dropMalformed("status");
            if (!accept(status->epoch(), ears_->servers->status, info.writer)) return;
            status_writer_ = info.writer;
            keep(Sample::STATUS, 0, status->SerializeAsString());
            state_.status = std::move(status);
        });
}

void SessionMirror::takeSceneInfo() {
    ears_->servers->scene_info.take(
        kMostSmallSamples, [this](const dds::SceneInfoSample& sample, const dds::SampleInfo& info) {
            if (!info.has_data || sample.session != session_) return;
            const std::optional<topics::SceneInfo> scene = parseSceneInfo(dds::payloadOf(sample));
            if (!scene) return dropMalformed("scene info");
            if (!accept(scene->epoch(), ears_->servers->scene_info, info.writer)) return;
            if (state_.small.contains({Sample::SCENE_INFO, 0}) && scene->revision() < scene_revision_) return;
            scene_revision_ = scene->revision();
            p_WV_ = {scene->p_wv_m(0), scene->p_wv_m(1), scene->p_wv_m(2)};
            q_WV_ = {scene->q_wv(0), scene->q_wv(1), scene->q_wv(2), scene->q_wv(3)};
            keep(Sample::SCENE_INFO, 0, scene->SerializeAsString());
        });
}

void SessionMirror::takeLesson() {
    ears_->servers->lesson.take(kMostSmallSamples,
                                [this](const dds::LessonSample& sample, const dds::SampleInfo& info) {
                                    if (!info.has_data || sample.session != session_) return;
                                    const auto lesson = parseLesson(dds::payloadOf(sample));
                                    if (!lesson) return dropMalformed("lesson");
                                    if (!accept(lesson->epoch(), ears_->servers->lesson, info.writer)) return;
                                    keep(Sample::LESSON, 0, lesson->SerializeAsString());
                                });
}

void SessionMirror::takePictures() {
    ears_->servers->pictures.take(
        kMostSmallSamples, [this](const dds::ScenePictureSample& sample, const dds::SampleInfo& info) {
            if (!info.has_data || sample.session != session_) return;
            const auto picture = parseScenePicture(dds::payloadOf(sample), sample.scene);
            if (!picture) return dropMalformed("picture of a scene");
            if (!accept(picture->epoch(), ears_->servers->pictures, info.writer)) return;
            keep(Sample::SCENE_PICTURE, sample.scene, picture->SerializeAsString());
        });
}

void SessionMirror::takeStructures() {
    ears_->servers->structures.take(
        kMostSmallSamples, [this](const dds::StructureMeshSample& sample, const dds::SampleInfo& info) {
            if (!info.has_data || sample.session != session_) return;
            const auto structure = parseStructure(dds::payloadOf(sample), sample.structure);
            if (!structure) return dropMalformed("structure");
            if (!accept(structure->epoch, ears_->servers->structures, info.writer)) return;
            keep(Sample::STRUCTURE_MESH, sample.structure, bytesOf(dds::payloadOf(sample)));
        });
}

void SessionMirror::takeToolState() {
    ears_->servers->tool_state.take(
        kMostSmallSamples, [this](const dds::ToolStateSample& sample, const dds::SampleInfo& info) {
            if (!info.has_data || sample.session != session_) return;
            std::optional<topics::ToolState> state = parseToolState(dds::payloadOf(sample));
            if (!state) return dropMalformed("tool state");
            if (!accept(state->epoch(), ears_->servers->tool_state, info.writer)) return;
            if (state_.tool_state && state->tick() < state_.tool_state->tick()) return;
            if (state->has_effects()) {
                topics::EffectState counted = state->effects();
                if (changes_.counted) {
                    counted.set_events(counted.events() | changes_.counted->events());
                    counted.set_removed_mm3(counted.removed_mm3() + changes_.counted->removed_mm3());
                }
                changes_.counted = std::move(counted);
            }
            changes_.has_tool_state = true;
            state_.tool_state = std::move(state);
        });
    if (changes_.has_tool_state) placeTool();
}

void SessionMirror::placeTool() {
    const auto& p = state_.tool_state->p_wt_m();
    state_.tool_V = (q_WV_.conjugate() * (Eigen::Vector3d(p[0], p[1], p[2]) - p_WV_)).cast<float>();
}

void SessionMirror::takeNodes() {
    const auto& reader = ears_->servers->nodes;
    ears_->servers->nodes.take(
        kMostNodes, [&](const dds::NodeMeshSample& sample, const dds::SampleInfo& info) {
            if (sample.session != session_) return;
            if (info.is_disposed) {
                if (choice_.isOurs(server_numbers_.of(reader.participantOf(info.writer), info.writer)))
                    model_.removeNode(sample.node);
                return;
            }
            if (!info.has_data) return;
            std::optional<DecodedNode> node = parseNode(dds::payloadOf(sample), sample.node, sample.revision);
            if (!node) return dropMalformed("node mesh");
            if (!accept(node->tag.epoch, reader, info.writer)) return;
            const auto shown = state_.nodes.find(sample.node);
            if (shown != state_.nodes.end() && sample.revision <= shown->second.revision) return;
            const Eigen::Vector3f place_V = node->mesh.origin;
            if (!model_.applyNode(std::move(*node), SceneModel::Clock::now()))
                return dropMalformed("node mesh, which is one too many");
            arrived_[{sample.node, sample.revision}] = {
                std::make_shared<const std::string>(bytesOf(dds::payloadOf(sample))), place_V};
        });
}

// The model says what is shown together; its bytes were kept meanwhile.
void SessionMirror::releaseNodes() {
    for (const SceneModel::Change& change : model_.takeChanges(SceneModel::Clock::now()).nodes) {
        const uint32_t leaf = change.mesh.leaf;
        changes_.nodes.push_back(leaf);
        if (change.mesh.isEmpty()) {
            state_.nodes.erase(leaf);
            continue;
        }
        const auto arrived = arrived_.find({leaf, change.mesh.revision});
        if (arrived == arrived_.end()) continue;  // it is shown already
        state_.nodes[leaf] = {arrived->second.payload, change.mesh.revision, arrived->second.place_V};
        arrived_.erase(arrived_.lower_bound({leaf, 0}), std::next(arrived));
    }
}

void SessionMirror::takeViewers() {
    const auto now = Clock::now();
    size_t heard = 0;
    ears_->viewers.take(kMostSmallSamples, [&](const dds::ViewerSample& sample, const dds::SampleInfo& info) {
        if (!info.has_data || sample.session != session_) return;
        std::optional<topics::Viewer> viewer = parseViewer(dds::payloadOf(sample), sample.sender);
        if (!viewer) return dropMalformed("viewer");
        viewers_.hear(std::move(*viewer), ears_->viewers.participantOf(info.writer), now);
        ++heard;
    });
    if (heard == 0 && now - listed_ < kListEvery) return;
    listed_ = now;
    viewers_.forgetSilent(now);
    showViewers();
}

void SessionMirror::showViewers() {
    std::map<uint64_t, std::string> listed;
    for (const topics::Viewer& viewer : viewers_.viewers())
        listed[viewer.sender()] = viewer.SerializeAsString();
    std::vector<uint64_t> gone;
    for (const auto& [key, payload] : state_.small)
        if (key.topic == Sample::VIEWER && !listed.contains(key.key)) gone.push_back(key.key);
    for (const uint64_t sender : gone) forget(Sample::VIEWER, sender);
    for (auto& [sender, bytes] : listed) {
        const auto shown = state_.small.find({Sample::VIEWER, sender});
        if (shown == state_.small.end() || *shown->second != bytes)
            keep(Sample::VIEWER, sender, std::move(bytes));
    }
}

void SessionMirror::takeRemarks() {
    const auto& reader = ears_->servers->remarks;
    ears_->servers->remarks.take(
        kMostSmallSamples, [&](const dds::RemarkSample& sample, const dds::SampleInfo& info) {
            if (sample.session != session_) return;
            if (info.is_disposed) {
                if (choice_.isOurs(server_numbers_.of(reader.participantOf(info.writer), info.writer)))
                    forget(Sample::REMARK, sample.place);
                return;
            }
            if (!info.has_data) return;
            const auto remark = parseRemark(dds::payloadOf(sample), sample.place);
            if (!remark) return dropMalformed("remark");
            if (accept(remark->epoch(), reader, info.writer))
                keep(Sample::REMARK, sample.place, remark->SerializeAsString());
        });
}

void SessionMirror::takeBricks() {
    if (!ears_->bricks) return;
    ears_->bricks->take(
        kMostBricks, [this](const dds::DensityBrickSample& sample, const dds::SampleInfo& info) {
            if (!info.has_data || sample.session != session_) return;
            const uint64_t participant = ears_->bricks->participantOf(info.writer);
            if (!choice_.isOurs(server_numbers_.of(participant, info.writer))) return;
            const auto brick = parseDensityBrick(dds::payloadOf(sample));
            if (!brick) return dropMalformed("density brick");
            if (brick->epoch() != state_.epoch) return;
            changes_.bricks.push_back(
                {sample.brick, std::make_shared<const std::string>(bytesOf(dds::payloadOf(sample)))});
        });
}

template <class Sample>
bool SessionMirror::accept(uint64_t epoch, const Inlet<Sample>& reader, uint64_t writer) {
    const auto now = ServerChoice::Clock::now();
    const bool is_status = std::is_same_v<Sample, dds::StatusSample>;
    const ServerChoice::Message message{epoch, server_numbers_.of(reader.participantOf(writer), writer),
                                        is_status};
    const bool was_ours = choice_.isOurs(message.server);
    if (choice_.judge(message, isServerAlive(), now) != ServerChoice::Verdict::kOurs) return false;
    if (!was_ours || epoch != model_.epoch()) beginRun();
    last_heard_ = now;
    return true;
}

// Viewers are no server's: they stay.
void SessionMirror::beginRun() {
    model_.begin(choice_.epoch());
    std::map<SmallKey, Payload> viewers;
    for (auto& [key, payload] : state_.small)
        if (key.topic == Sample::VIEWER) viewers.emplace(key, std::move(payload));
    state_ = {};
    state_.epoch = choice_.epoch();
    state_.small = std::move(viewers);
    changes_ = {};
    changes_.is_cleared = true;
    for (const auto& [key, payload] : state_.small) changes_.small.push_back(key);
    arrived_.clear();
    status_writer_ = 0;
}

// What was refused before it was known to be our server's is read anew, and so is what may be shown when ours
// is gone; the latter not again and again.
void SessionMirror::readAnewIfDue() {
    const auto now = Clock::now();
    const bool is_due = !read_anew_ || now - *read_anew_ > kReadAnewAgain;
    const bool has_candidate = is_due && choice_.hasCandidate() && !isServerAlive();
    if (!choice_.takeLost() && !has_candidate) return;
    if (has_candidate) read_anew_ = now;
    ears_->readAnew();
    choice_.forgetRefused();
}

bool SessionMirror::isHeard() const {
    return last_heard_ && Clock::now() - *last_heard_ < SceneSubscriber::kServerTimeout;
}

bool SessionMirror::isServerAlive() const {
    return isHeard() && (status_writer_ == 0 || ears_->servers->status.isMatched(status_writer_));
}

void SessionMirror::noteEnd() {
    const bool was_matched = std::exchange(is_matched_, ears_->servers->status.matchedWriters() > 0);
    if (is_matched_)
        state_.has_ended = false;
    else if (was_matched)
        state_.has_ended = isHeard();
}

void SessionMirror::dropMalformed(const char* what) {
    if (++malformed_count_ > kMostNamed) return;
    spdlog::warn("dropped a malformed {}{}", what,
                 malformed_count_ == kMostNamed ? "; from now on they are only counted" : "");
}

}  // namespace bonemill::gateway
