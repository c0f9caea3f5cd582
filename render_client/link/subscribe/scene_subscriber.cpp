#include "render_client/link/subscribe/scene_subscriber.h"

#include <spdlog/spdlog.h>

#include <random>
#include <thread>
#include <utility>

#include "common/base/user_error.h"
#include "common/rt/clock.h"

namespace bonemill {
namespace {

uint64_t randomSender() {
    std::random_device device;
    uint64_t sender = 0;
    while (sender == 0) sender = (static_cast<uint64_t>(device()) << 32) | device();
    return sender;
}

}  // namespace

SceneSubscriber::SceneSubscriber(const SubscriberOptions& options)
    : options_(options),
      outbox_(randomSender()),
      link_(std::make_unique<SessionLink>(options.domain, options.remote.get(), options.session,
                                          outbox_.sender(), options.role, next_wish_)),
      ear_(options.session, *this, outbox_.sender(), options.rejoin_after) {
    ear_.join(link_->wire);
}

SceneModel::Changes SceneSubscriber::poll(size_t max_nodes) {
    ear_.passTime();
    ear_.poll(max_nodes);
    if (max_nodes == kAllNodes) ear_.takeRestOfBatch();
    if (link_) sendCommands();
    rejoinIfDeaf();
    return ear_.model().takeChanges(SceneModel::Clock::now());
}

void SceneSubscriber::sendCommands() {
    if (!link_->command_writer.isAllowed()) outbox_.refuseAll("refused: the identity of --secure only looks");
    outbox_.step(CommandOutbox::Clock::now(), link_->command_writer.matchedReaders() > 0,
                 [this](const topics::Command& command) {
                     link_->command_writer.write(options_.session, command.sender(),
                                                 command.SerializeAsString());
                 });
}

bool SceneSubscriber::waitForData(std::chrono::nanoseconds timeout) const {
    if (link_) return ear_.wait(timeout);
    std::this_thread::sleep_for(timeout);
    return false;
}

void SceneSubscriber::followDensities(DensityStore& densities) {
    if (!link_) return;
    const auto is_ours = [this](uint64_t participant, uint64_t writer) {
        return ear_.isOurs(participant, writer);
    };
    link_->density_feed.update(densities, {scene_info_, epoch(), is_ours}, monotonicNowNs(),
                               [this](const std::string& what) { ear_.dropMalformed(what); });
}

void SceneSubscriber::beginRun() {
    scene_info_.reset();
    tool_state_.reset();
    lesson_.reset();
    pictures_.clear();
    remark_changes_ += !remarks_.empty();
    remarks_.clear();
    structure_changes_ += !structures_.empty();
    structures_.clear();
    structure_triangles_ = 0;
}

void SceneSubscriber::hear(topics::Lesson&& lesson) {
    lesson_ = std::move(lesson);
    showPictures();
}

void SceneSubscriber::hear(topics::ScenePicture&& picture, uint32_t scene) {
    pictures_[scene] = std::move(picture);
    showPictures();
}

void SceneSubscriber::showPictures() {
    if (!lesson_) return;
    for (const auto& [scene, picture] : pictures_) {
        if (int(scene) >= lesson_->scenes_size()) continue;
        topics::SceneChoice& choice = *lesson_->mutable_scenes(int(scene));
        if (choice.id() == picture.scene_id()) choice.set_picture(picture.png());
    }
}

void SceneSubscriber::hear(StructureSurface&& structure, const dds::StructureMeshSample& sample) {
    const auto known = structures_.find(sample.structure);
    const size_t triangles = structure.mesh.indices.size() / 3;
    const size_t others =
        structure_triangles_ - (known == structures_.end() ? 0 : known->second.mesh.indices.size() / 3);
    if (others + triangles > kMaxTrianglesOfStructures)
        return ear_.dropMalformed("structure " + std::to_string(sample.structure) +
                                  ", which is one too many");
    structure_triangles_ = others + triangles;
    structure.change = ++structure_changes_;
    structures_[sample.structure] = std::move(structure);
}

void SceneSubscriber::hear(std::optional<topics::Remark>&& remark, uint32_t place) {
    if (remark)
        remarks_[place] = std::move(*remark), ++remark_changes_;
    else
        remark_changes_ += remarks_.erase(place);
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
    link_->viewer_writer.write(options_.session, viewer.sender(), viewer.SerializeAsString());
}

uint32_t SceneSubscriber::sendCommand(topics::Command command) {
    command.set_role(options_.role);
    command.set_name(options_.name);
    return outbox_.enqueue(std::move(command));
}

// Gateways are reached anew by themselves.
void SceneSubscriber::rejoinIfDeaf() {
    if (options_.remote || !ear_.isDeaf()) return;
    ++rejoinings_;
    if (link_) next_wish_ = link_->hand.stop();
    ear_.leave();
    link_.reset();  // before the new one, or Cyclone would go on with what it has of this domain
    try {
        link_ = std::make_unique<SessionLink>(options_.domain, nullptr, options_.session, outbox_.sender(),
                                              options_.role, next_wish_);
        ear_.join(link_->wire);
    } catch (const UserError& error) {
        link_.reset();
        spdlog::warn("the session cannot be joined anew: {}", error.what());
    }
}

}  // namespace bonemill
