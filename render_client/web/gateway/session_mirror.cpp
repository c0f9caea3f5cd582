#include "render_client/web/gateway/session_mirror.h"

#include <utility>

#include "render_client/link/subscribe/payloads.h"

namespace bonemill::gateway {
namespace {

constexpr size_t kMaxNodes = 512, kMaxBricks = 256;  // per look
constexpr std::chrono::milliseconds kListEvery{500};

std::string bytesOf(std::span<const uint8_t> payload) {
    return {reinterpret_cast<const char*>(payload.data()), payload.size()};
}

}  // namespace

void SessionMirror::join(const dds::Participant& participant) {
    ear_.join(participant);
    participant_ = &participant;
}

void SessionMirror::leave() {
    bricks_.reset();
    ear_.leave();
    participant_ = nullptr;
}

SessionChanges SessionMirror::poll() {
    ear_.poll(kMaxNodes);
    if (bricks_) takeBricks();
    releaseNodes();
    const auto now = Clock::now();
    if (std::exchange(has_heard_viewers_, false) || now - listed_ >= kListEvery) {
        listed_ = now;
        showViewers();
    }
    state_.has_ended = ear_.hasEnded();
    state_.has_server = ear_.hasServer();
    return std::exchange(changes_, {});
}

void SessionMirror::hearBricks(bool should_hear) {
    if (!should_hear)
        bricks_.reset();
    else if (!bricks_ && participant_)
        bricks_.emplace(*participant_);
}

void SessionMirror::keep(Topic topic, uint64_t key, std::string payload) {
    state_.small[{topic, key}] = std::make_shared<const std::string>(std::move(payload));
    changes_.small.push_back({topic, key});
}

void SessionMirror::forget(Topic topic, uint64_t key) {
    if (state_.small.erase({topic, key}) > 0) changes_.small.push_back({topic, key});
}

void SessionMirror::hear(const topics::Status& status) {
    keep(Sample::STATUS, 0, status.SerializeAsString());
    state_.status = status;
}

void SessionMirror::hear(topics::SceneInfo&& info) {
    p_WV_ = {info.p_wv_m(0), info.p_wv_m(1), info.p_wv_m(2)};
    q_WV_ = {info.q_wv(0), info.q_wv(1), info.q_wv(2), info.q_wv(3)};
    keep(Sample::SCENE_INFO, 0, info.SerializeAsString());
}

void SessionMirror::hear(StructureSurface&&, const dds::StructureMeshSample& sample) {
    keep(Sample::STRUCTURE_MESH, sample.structure, bytesOf(dds::payloadOf(sample)));
}

void SessionMirror::hear(topics::ToolState&& state) {
    if (state.has_effects()) changes_.counted = state.effects();
    changes_.has_tool_state = true;
    const auto& p = state.p_wt_m();
    state_.tool_V = (q_WV_.conjugate() * (Eigen::Vector3d(p[0], p[1], p[2]) - p_WV_)).cast<float>();
    state_.tool_state = std::move(state);
}

void SessionMirror::hear(std::optional<topics::Remark>&& remark, uint32_t place) {
    if (remark)
        keep(Sample::REMARK, place, remark->SerializeAsString());
    else
        forget(Sample::REMARK, place);
}

void SessionMirror::hear(const dds::NodeMeshSample& sample, const Eigen::Vector3f& origin_V) {
    const auto shown = state_.nodes.find(sample.node);
    if (shown != state_.nodes.end() && sample.revision <= shown->second.revision) return;
    arrived_[{sample.node, sample.revision}] = {
        std::make_shared<const std::string>(bytesOf(dds::payloadOf(sample))), origin_V};
}

// The model says what is shown together; its bytes were kept meanwhile.
void SessionMirror::releaseNodes() {
    for (const SceneModel::Change& change : ear_.model().takeChanges(SceneModel::Clock::now()).nodes) {
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

void SessionMirror::showViewers() {
    std::map<uint64_t, std::string> listed;
    for (const topics::Viewer& viewer : ear_.viewers().viewers())
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

void SessionMirror::takeBricks() {
    bricks_->take(kMaxBricks, [this](const dds::DensityBrickSample& sample, const dds::SampleInfo& info) {
        if (!info.has_data || sample.session != session_) return;
        if (!ear_.isOurs(bricks_->participantOf(info.writer), info.writer)) return;
        const auto brick = parseDensityBrick(dds::payloadOf(sample));
        if (!brick) return ear_.dropMalformed("density brick");
        if (brick->epoch() != state_.epoch) return;
        changes_.bricks.push_back(
            {sample.brick, std::make_shared<const std::string>(bytesOf(dds::payloadOf(sample)))});
    });
}

// Viewers are no server's: they stay.
void SessionMirror::beginRun() {
    std::map<SmallKey, Payload> viewers;
    for (auto& [key, payload] : state_.small)
        if (key.topic == Sample::VIEWER) viewers.emplace(key, std::move(payload));
    state_ = {};
    state_.epoch = ear_.model().epoch();
    state_.small = std::move(viewers);
    changes_ = {};
    changes_.is_cleared = true;
    for (const auto& [key, payload] : state_.small) changes_.small.push_back(key);
    arrived_.clear();
}

}  // namespace bonemill::gateway
