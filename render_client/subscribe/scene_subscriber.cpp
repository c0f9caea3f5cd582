#include "render_client/subscribe/scene_subscriber.h"

#include <spdlog/spdlog.h>

#include <random>
#include <utility>

#include "common/rt/clock.h"

namespace bonemill {
namespace {

// Few samples per session are kept, so more than this many at once is a flood of foreign sessions.
constexpr size_t kMaxSmallSamples = 256;
constexpr uint64_t kMostNamed = 16;  // malformed samples in the log: a hostile peer must not fill it
constexpr size_t kMaxViewers = 256;  // bounds what invented senders can take

uint64_t randomSender() {
    std::random_device device;
    uint64_t sender = 0;
    while (sender == 0) sender = (static_cast<uint64_t>(device()) << 32) | device();
    return sender;
}

// None of the states between two pictures is shown, so what happened in them is added up.
void addCounts(const topics::EffectState& before, topics::EffectState& now) {
    now.set_events(now.events() | before.events());
    now.set_removed_mm3(now.removed_mm3() + before.removed_mm3());
}

}  // namespace

SceneSubscriber::SceneSubscriber(const SubscriberOptions& options)
    : options_(options),
      outbox_(randomSender()),
      participant_(options.domain),
      viewer_reader_(participant_),
      servers_(std::make_unique<ServerReaders>(participant_, viewer_reader_.handle())),
      viewer_writer_(participant_),
      hand_(participant_, options.session, outbox_.sender(), options.role),
      density_feed_(participant_, options.session, outbox_.sender()),
      command_writer_(participant_) {}

SceneModel::Changes SceneSubscriber::poll(size_t max_nodes) {
    if (choice_.hasLost()) readAnew();
    if (choice_.hasRefused() && !isServerAlive()) {
        readAnew();
        status_writer_ = 0;
        last_heard_.reset();
    }
    takeSceneInfo();
    takeStatus();
    takeLesson();
    takeStructures();
    takeNodes(max_nodes);
    takeToolState();
    takeViewers();
    noteEnd();
    outbox_.step(CommandOutbox::Clock::now(), command_writer_.matchedReaders() > 0,
                 [this](const topics::Command& command) {
                     const std::string bytes = command.SerializeAsString();
                     dds::CommandSample sample{};
                     sample.session = options_.session;
                     sample.sender = command.sender();
                     dds::setPayload(sample, bytes);
                     command_writer_.write(sample);
                 });
    return model_.takeChanges(SceneModel::Clock::now());
}

void SceneSubscriber::followDensities(DensityStore& densities) {
    density_feed_.update(densities, scene_info_, epoch(), monotonicNowNs(),
                         [this](const std::string& what) { dropMalformed(what); });
}

void SceneSubscriber::takeStatus() {
    servers_->status.take(kMaxSmallSamples,
                          [this](const dds::StatusSample& sample, const dds::SampleInfo& info) {
                              if (!info.has_data || sample.session != options_.session) return;
                              std::optional<topics::Status> status = parseStatus(dds::payloadOf(sample));
                              if (!status) return dropMalformed("status");
                              if (!enterEpoch(status->epoch(), info.writer)) {
                                  other_scene_ = status->scene();
                                  return;
                              }
                              status_writer_ = info.writer;
                              outbox_.acknowledge(*status);
                              status_ = std::move(status);
                          });
}

void SceneSubscriber::takeLesson() {
    servers_->lesson.take(kMaxSmallSamples,
                          [this](const dds::LessonSample& sample, const dds::SampleInfo& info) {
                              if (!info.has_data || sample.session != options_.session) return;
                              std::optional<topics::Lesson> lesson = parseLesson(dds::payloadOf(sample));
                              if (!lesson) return dropMalformed("lesson");
                              if (enterEpoch(lesson->epoch(), info.writer)) lesson_ = std::move(lesson);
                          });
}

void SceneSubscriber::takeSceneInfo() {
    servers_->scene_info.take(
        kMaxSmallSamples, [this](const dds::SceneInfoSample& sample, const dds::SampleInfo& info) {
            if (!info.has_data || sample.session != options_.session) return;
            std::optional<topics::SceneInfo> scene_info = parseSceneInfo(dds::payloadOf(sample));
            if (!scene_info) return dropMalformed("scene info");
            if (!enterEpoch(scene_info->epoch(), info.writer)) return;
            if (scene_info_ && scene_info->revision() < scene_info_->revision()) return;
            scene_info_ = std::move(scene_info);
        });
}

void SceneSubscriber::takeStructures() {
    servers_->structures.take(kMaxSmallSamples, [this](const dds::StructureMeshSample& sample,
                                                       const dds::SampleInfo& info) {
        if (!info.has_data || sample.session != options_.session) return;
        std::optional<StructureSurface> structure = parseStructure(dds::payloadOf(sample), sample.structure);
        if (!structure) return dropMalformed("structure " + std::to_string(sample.structure));
        if (!enterEpoch(structure->epoch, info.writer)) return;
        structures_[sample.structure] = std::move(*structure);
        ++structure_changes_;
    });
}

void SceneSubscriber::takeToolState() {
    std::optional<topics::EffectState> counted;
    servers_->tool_state.take(
        kMaxSmallSamples, [&](const dds::ToolStateSample& sample, const dds::SampleInfo& info) {
            if (!info.has_data || sample.session != options_.session) return;
            std::optional<topics::ToolState> state = parseToolState(dds::payloadOf(sample));
            if (!state) return dropMalformed("tool state");
            if (!enterEpoch(state->epoch(), info.writer)) return;
            if (tool_state_ && state->tick() < tool_state_->tick()) return;
            if (!tool_state_) counted.reset();  // another run of the server
            if (counted && state->has_effects()) addCounts(*counted, *state->mutable_effects());
            if (state->has_effects()) counted = state->effects();
            tool_state_ = std::move(state);
        });
}

void SceneSubscriber::takeViewers() {
    const auto now = std::chrono::steady_clock::now();
    viewer_reader_.take(kMaxSmallSamples, [&](const dds::ViewerSample& sample, const dds::SampleInfo& info) {
        if (!info.has_data || sample.session != options_.session || sample.sender == outbox_.sender()) return;
        std::optional<topics::Viewer> viewer = parseViewer(dds::payloadOf(sample), sample.sender);
        if (!viewer) return dropMalformed("viewer " + std::to_string(sample.sender));
        if (viewers_.size() < kMaxViewers || viewers_.contains(sample.sender))
            viewers_[sample.sender] = {std::move(*viewer), now};
    });
    std::erase_if(viewers_, [now](const auto& v) { return now - v.second.heard > kViewerTimeout; });
}

void SceneSubscriber::announce(double frame_rate_hz, const std::optional<Eigen::Vector3d>& pointer_W,
                               bool is_holding) {
    topics::Viewer viewer;
    viewer.set_sender(outbox_.sender());
    viewer.set_name(options_.name);
    viewer.set_role(options_.role);
    viewer.set_frame_rate_hz(frame_rate_hz);
    viewer.set_is_complete(isComplete());
    viewer.set_is_holding(is_holding);
    if (pointer_W) viewer.mutable_pointer_m()->Assign(pointer_W->begin(), pointer_W->end());
    const std::string bytes = viewer.SerializeAsString();
    dds::ViewerSample sample{};
    sample.session = options_.session;
    sample.sender = viewer.sender();
    dds::setPayload(sample, bytes);
    viewer_writer_.write(sample);
}

uint32_t SceneSubscriber::sendCommand(topics::Command command) {
    command.set_role(options_.role);
    return outbox_.enqueue(std::move(command));
}

std::vector<topics::Viewer> SceneSubscriber::viewers() const {
    std::vector<topics::Viewer> viewers;
    for (const auto& [sender, heard] : viewers_) viewers.push_back(heard.viewer);
    return viewers;
}

void SceneSubscriber::takeNodes(size_t max_nodes) {
    servers_->nodes.take(max_nodes, [this](const dds::NodeMeshSample& sample, const dds::SampleInfo& info) {
        if (sample.session != options_.session) return;
        // Of a key that was written and then disposed only the older sample may be left, marked as disposed.
        if (info.is_disposed) {
            if (!choice_.isOther(info.writer)) model_.removeNode(sample.node, info.writer);
            return;
        }
        if (!info.has_data) return;
        std::optional<DecodedNode> node = parseNode(dds::payloadOf(sample), sample.node, sample.revision);
        if (!node) return dropMalformed("node mesh " + std::to_string(sample.node));
        if (!enterEpoch(node->tag.epoch, info.writer) &&
            (choice_.isOther(info.writer) || node->tag.epoch > model_.epoch()))
            return;
        // The model takes nodes of an older run too: it remembers their writer, whose late
        // removals must not count.
        model_.applyNode(std::move(*node), info.writer, SceneModel::Clock::now());
    });
}

bool SceneSubscriber::enterEpoch(uint64_t epoch, uint64_t writer) {
    const auto now = ServerChoice::Clock::now();
    if (choice_.judge(epoch, writer, isServerAlive(), now) != ServerChoice::Verdict::kOurs) return false;
    const uint64_t epoch_before = model_.epoch();
    if (!model_.enterEpoch(epoch)) return false;
    if (model_.epoch() != epoch_before) {
        scene_info_.reset();
        tool_state_.reset();
        status_.reset();
        lesson_.reset();
        structure_changes_ += !structures_.empty();
        structures_.clear();
        status_writer_ = 0;
    }
    last_heard_ = std::chrono::steady_clock::now();
    return true;
}

// What was refused meanwhile, DDS gives to new readers only.
void SceneSubscriber::readAnew() {
    servers_ = std::make_unique<ServerReaders>(participant_, viewer_reader_.handle());
    choice_.forgetWriters();
}

bool SceneSubscriber::isServerAlive() const {
    return isHeard() && (status_writer_ == 0 || servers_->status.isMatched(status_writer_));
}

std::optional<std::string> SceneSubscriber::otherServer() const {
    return choice_.hasOther(ServerChoice::Clock::now()) ? std::optional(other_scene_) : std::nullopt;
}

void SceneSubscriber::dropMalformed(const std::string& what) {
    if (++malformed_count_ > kMostNamed) return;
    spdlog::warn("dropped a malformed {}{}", what,
                 malformed_count_ == kMostNamed ? "; from now on they are only counted" : "");
}

bool SceneSubscriber::isComplete() const {
    return status_ && !status_->is_model_partial() && status_->node_count() == digest().count() &&
           status_->node_digest() == digest().value();
}

bool SceneSubscriber::isHeard() const {
    return last_heard_ && std::chrono::steady_clock::now() - *last_heard_ < kServerTimeout;
}

bool SceneSubscriber::hasServer() const {
    return is_matched_ && isHeard();
}

void SceneSubscriber::noteEnd() {
    const bool was_matched = std::exchange(is_matched_, servers_->status.matchedWriters() > 0);
    if (is_matched_) {
        has_ended_ = false;
    } else if (was_matched) {
        has_ended_ = isHeard();
    }
}

}  // namespace bonemill
