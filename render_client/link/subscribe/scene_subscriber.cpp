#include "render_client/link/subscribe/scene_subscriber.h"

#include <spdlog/spdlog.h>

#include <random>
#include <thread>
#include <type_traits>
#include <utility>

#include "common/base/user_error.h"
#include "common/rt/clock.h"

namespace bonemill {
namespace {

// Few samples per session are kept, so more than this many at once is a flood of foreign sessions.
constexpr size_t kMaxSmallSamples = 256;
constexpr uint64_t kMostNamed = 16;  // malformed samples in the log: a hostile peer must not fill it
constexpr std::chrono::seconds kReadAnewAgain{2};

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
      hearing_(options.rejoin_after),
      outbox_(randomSender()),
      link_(std::make_unique<SessionLink>(options.domain, options.remote.get(), options.session,
                                          outbox_.sender(), options.role, next_wish_)) {}

SceneModel::Changes SceneSubscriber::poll(size_t max_nodes) {
    noteTime();
    if (link_) takeAll(max_nodes);
    noteNothingToHear();
    rejoinIfDeaf();
    return model_.takeChanges(SceneModel::Clock::now());
}

void SceneSubscriber::takeAll(size_t max_nodes) {
    takeStatus();
    readAnewIfDue();
    takeSceneInfo();
    takeLesson();
    takePictures();
    takeStructures();
    takeNodes(max_nodes);
    takeToolState();
    takeViewers();
    takeRemarks();
    noteEnd();
    if (!link_->command_writer.isAllowed()) outbox_.refuseAll("refused: the identity of --secure only looks");
    outbox_.step(CommandOutbox::Clock::now(), link_->command_writer.matchedReaders() > 0,
                 [this](const topics::Command& command) {
                     const std::string bytes = command.SerializeAsString();
                     dds::CommandSample sample{};
                     sample.session = options_.session;
                     sample.sender = command.sender();
                     dds::setPayload(sample, bytes);
                     link_->command_writer.write(sample);
                 });
}

bool SceneSubscriber::waitForData(std::chrono::nanoseconds timeout) const {
    if (link_) return link_->servers->wait(timeout);
    std::this_thread::sleep_for(timeout);
    return false;
}

void SceneSubscriber::followDensities(DensityStore& densities) {
    if (!link_) return;
    const auto is_ours = [this](uint64_t participant, uint64_t writer) {
        return choice_.isOurs(server_numbers_.of(participant, writer));
    };
    link_->density_feed.update(densities, {scene_info_, epoch(), is_ours}, monotonicNowNs(),
                               [this](const std::string& what) { dropMalformed(what); });
}

void SceneSubscriber::takeStatus() {
    link_->servers->status.take(
        kMaxSmallSamples, [this](const dds::StatusSample& sample, const dds::SampleInfo& info) {
            if (!info.has_data || sample.session != options_.session) return;
            std::optional<topics::Status> status = parseStatus(dds::payloadOf(sample));
            if (!status) return dropMalformed("status");
            if (!accept(status->epoch(), link_->servers->status, info.writer)) {
                other_scene_ = status->scene();
                return;
            }
            status_writer_ = info.writer;
            outbox_.acknowledge(*status);
            status_ = std::move(status);
        });
}

void SceneSubscriber::takeLesson() {
    link_->servers->lesson.take(
        kMaxSmallSamples, [this](const dds::LessonSample& sample, const dds::SampleInfo& info) {
            if (!info.has_data || sample.session != options_.session) return;
            std::optional<topics::Lesson> lesson = parseLesson(dds::payloadOf(sample));
            if (!lesson) return dropMalformed("lesson");
            if (!accept(lesson->epoch(), link_->servers->lesson, info.writer)) return;
            lesson_ = std::move(lesson);
            showPictures();
        });
}

void SceneSubscriber::takePictures() {
    link_->servers->pictures.take(kMaxSmallSamples, [this](const dds::ScenePictureSample& sample,
                                                           const dds::SampleInfo& info) {
        if (!info.has_data || sample.session != options_.session) return;
        std::optional<topics::ScenePicture> picture = parseScenePicture(dds::payloadOf(sample), sample.scene);
        if (!picture) return dropMalformed("picture of scene " + std::to_string(sample.scene));
        if (!accept(picture->epoch(), link_->servers->pictures, info.writer)) return;
        pictures_[sample.scene] = std::move(*picture);
        showPictures();
    });
}

void SceneSubscriber::showPictures() {
    if (!lesson_) return;
    for (const auto& [scene, picture] : pictures_) {
        if (int(scene) >= lesson_->scenes_size()) continue;
        topics::SceneChoice& choice = *lesson_->mutable_scenes(int(scene));
        if (choice.id() == picture.scene_id()) choice.set_picture(picture.png());
    }
}

void SceneSubscriber::takeSceneInfo() {
    link_->servers->scene_info.take(
        kMaxSmallSamples, [this](const dds::SceneInfoSample& sample, const dds::SampleInfo& info) {
            if (!info.has_data || sample.session != options_.session) return;
            std::optional<topics::SceneInfo> scene_info = parseSceneInfo(dds::payloadOf(sample));
            if (!scene_info) return dropMalformed("scene info");
            if (!accept(scene_info->epoch(), link_->servers->scene_info, info.writer)) return;
            if (scene_info_ && scene_info->revision() < scene_info_->revision()) return;
            scene_info_ = std::move(scene_info);
            if (scene_info_->leaf_count() > 0) model_.setLeafCount(scene_info_->leaf_count());
        });
}

void SceneSubscriber::takeStructures() {
    link_->servers->structures.take(kMaxSmallSamples, [this](const dds::StructureMeshSample& sample,
                                                             const dds::SampleInfo& info) {
        if (!info.has_data || sample.session != options_.session) return;
        std::optional<StructureSurface> structure = parseStructure(dds::payloadOf(sample), sample.structure);
        if (!structure) return dropMalformed("structure " + std::to_string(sample.structure));
        if (!accept(structure->epoch, link_->servers->structures, info.writer)) return;
        const auto known = structures_.find(sample.structure);
        const size_t triangles = structure->mesh.indices.size() / 3;
        const size_t others =
            structure_triangles_ - (known == structures_.end() ? 0 : known->second.mesh.indices.size() / 3);
        if (others + triangles > kMostTrianglesOfStructures)
            return dropMalformed("structure " + std::to_string(sample.structure) + ", which is one too many");
        structure_triangles_ = others + triangles;
        structure->change = ++structure_changes_;
        structures_[sample.structure] = std::move(*structure);
    });
}

void SceneSubscriber::takeToolState() {
    std::optional<topics::EffectState> counted;
    link_->servers->tool_state.take(
        kMaxSmallSamples, [&](const dds::ToolStateSample& sample, const dds::SampleInfo& info) {
            if (!info.has_data || sample.session != options_.session) return;
            std::optional<topics::ToolState> state = parseToolState(dds::payloadOf(sample));
            if (!state) return dropMalformed("tool state");
            if (!accept(state->epoch(), link_->servers->tool_state, info.writer)) return;
            if (tool_state_ && state->tick() < tool_state_->tick()) return;
            if (!tool_state_) counted.reset();  // another run of the server
            if (counted && state->has_effects()) addCounts(*counted, *state->mutable_effects());
            if (state->has_effects()) counted = state->effects();
            tool_state_ = std::move(state);
        });
}

void SceneSubscriber::takeViewers() {
    const auto now = ViewerList::Clock::now();
    link_->viewer_reader.take(
        kMaxSmallSamples, [&](const dds::ViewerSample& sample, const dds::SampleInfo& info) {
            if (!info.has_data || sample.session != options_.session || sample.sender == outbox_.sender())
                return;
            std::optional<topics::Viewer> viewer = parseViewer(dds::payloadOf(sample), sample.sender);
            if (!viewer) return dropMalformed("viewer " + std::to_string(sample.sender));
            viewers_.hear(std::move(*viewer), link_->viewer_reader.participantOf(info.writer), now);
        });
    viewers_.forgetSilent(now);
}

void SceneSubscriber::takeRemarks() {
    const auto& reader = link_->servers->remarks;
    link_->servers->remarks.take(
        kMaxSmallSamples, [&](const dds::RemarkSample& sample, const dds::SampleInfo& info) {
            if (sample.session != options_.session) return;
            if (info.is_disposed) {
                if (choice_.isOurs(server_numbers_.of(reader.participantOf(info.writer), info.writer)))
                    remark_changes_ += remarks_.erase(sample.place);
                return;
            }
            if (!info.has_data) return;
            std::optional<topics::Remark> remark = parseRemark(dds::payloadOf(sample), sample.place);
            if (!remark) return dropMalformed("remark " + std::to_string(sample.place));
            if (!accept(remark->epoch(), reader, info.writer)) return;
            remarks_[sample.place] = std::move(*remark);
            ++remark_changes_;
        });
}

void SceneSubscriber::announce(double frame_rate_hz, const std::optional<Eigen::Vector3d>& pointer_W,
                               bool is_holding, const std::optional<topics::Eye>& eye) {
    if (!link_) return;
    topics::Viewer viewer;
    viewer.set_sender(outbox_.sender());
    viewer.set_name(options_.name);
    viewer.set_role(options_.role);
    viewer.set_frame_rate_hz(frame_rate_hz);
    viewer.set_is_complete(isComplete());
    viewer.set_is_holding(is_holding);
    viewer.set_is_trainee(options_.is_trainee);
    if (eye) *viewer.mutable_eye() = *eye;
    if (pointer_W) viewer.mutable_pointer_m()->Assign(pointer_W->begin(), pointer_W->end());
    const std::string bytes = viewer.SerializeAsString();
    dds::ViewerSample sample{};
    sample.session = options_.session;
    sample.sender = viewer.sender();
    dds::setPayload(sample, bytes);
    link_->viewer_writer.write(sample);
}

uint32_t SceneSubscriber::sendCommand(topics::Command command) {
    command.set_role(options_.role);
    command.set_name(options_.name);
    return outbox_.enqueue(std::move(command));
}

void SceneSubscriber::takeNodes(size_t max_nodes) {
    link_->servers->nodes.take(
        max_nodes, [this](const dds::NodeMeshSample& sample, const dds::SampleInfo& info) {
            if (sample.session != options_.session) return;
            // Of a key that was written and then disposed only the older sample may be left, marked as
            // disposed.
            if (info.is_disposed) {
                const uint64_t participant = link_->servers->nodes.participantOf(info.writer);
                if (choice_.isOurs(server_numbers_.of(participant, info.writer)))
                    model_.removeNode(sample.node);
                return;
            }
            if (!info.has_data) return;
            std::optional<DecodedNode> node = parseNode(dds::payloadOf(sample), sample.node, sample.revision);
            if (!node) return dropMalformed("node mesh " + std::to_string(sample.node));
            if (!accept(node->tag.epoch, link_->servers->nodes, info.writer)) return;
            if (!model_.applyNode(std::move(*node), SceneModel::Clock::now()))
                dropMalformed("node mesh " + std::to_string(sample.node) + ", which is one too many");
        });
}

template <class Sample>
bool SceneSubscriber::accept(uint64_t epoch, const Inlet<Sample>& reader, uint64_t writer) {
    const auto now = ServerChoice::Clock::now();
    const bool is_status = std::is_same_v<Sample, dds::StatusSample>;
    const ServerChoice::Message message{epoch, server_numbers_.of(reader.participantOf(writer), writer),
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

void SceneSubscriber::beginRun() {
    model_.begin(choice_.epoch());
    scene_info_.reset();
    tool_state_.reset();
    status_.reset();
    lesson_.reset();
    pictures_.clear();
    remark_changes_ += !remarks_.empty();
    remarks_.clear();
    structure_changes_ += !structures_.empty();
    structures_.clear();
    structure_triangles_ = 0;
    status_writer_ = 0;
}

// What was refused before it was known to be our server's is read anew, and so is what may be shown when ours
// is gone; the latter not again and again.
void SceneSubscriber::readAnewIfDue() {
    const auto now = std::chrono::steady_clock::now();
    const bool is_due = !read_anew_ || now - *read_anew_ > kReadAnewAgain;
    const bool has_candidate = is_due && choice_.hasCandidate() && !isServerAlive();
    if (!choice_.takeLost() && !has_candidate) return;
    if (has_candidate) read_anew_ = now;
    link_->readAnew();
    choice_.forgetRefused();
}

// Gateways are reached anew by themselves.
void SceneSubscriber::rejoinIfDeaf() {
    if (options_.remote || !hearing_.isDue(Hearing::Clock::now())) return;
    ++rejoinings_;
    if (link_) next_wish_ = link_->hand.nextWish();
    link_.reset();  // before the new one, or Cyclone would go on with what it has of this domain
    join();
    server_numbers_.clear();
    status_writer_ = 0;
    choice_.forgetRefused();
}

void SceneSubscriber::join() {
    try {
        link_ = std::make_unique<SessionLink>(options_.domain, nullptr, options_.session, outbox_.sender(),
                                              options_.role, next_wish_);
    } catch (const UserError& error) {
        is_matched_ = false;
        spdlog::warn("the session cannot be joined anew: {}", error.what());
    }
}

void SceneSubscriber::noteTime() {
    const auto slept = hearing_.pass(Hearing::Clock::now());
    if (last_heard_) *last_heard_ += slept;
}

// No server, no tick since the tool was heard, no node that is missing.
void SceneSubscriber::noteNothingToHear() {
    const auto now = Hearing::Clock::now();
    const bool is_alive = link_ && isServerAlive() && status_;
    const uint64_t heard_ticks = tool_state_ ? tool_state_->tick() + 1 : 0;
    if (!is_alive || status_->ticks() <= heard_ticks) hearing_.hear(Hearing::kTool, now);
    if (!is_alive || isComplete()) hearing_.hear(Hearing::kNodes, now);
}

bool SceneSubscriber::isServerAlive() const {
    return isHeard() && (status_writer_ == 0 || link_->servers->status.isMatched(status_writer_));
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
    const bool was_matched = std::exchange(is_matched_, link_->servers->status.matchedWriters() > 0);
    if (is_matched_) {
        has_ended_ = false;
    } else if (was_matched) {
        has_ended_ = isHeard() && !link_->isCut();
    }
}

}  // namespace bonemill
