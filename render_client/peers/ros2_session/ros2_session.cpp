#include "render_client/peers/ros2_session/ros2_session.h"

#include <google/protobuf/util/json_util.h>
#include <spdlog/spdlog.h>

#include <thread>
#include <vector>

#include "common/base/user_error.h"
#include "common/device_messages/device_messages.h"
#include "render_client/link/subscribe/payloads.h"

namespace bonemill::ros2 {
namespace {

constexpr size_t kMaxNodes = 512, kMaxTicks = 64;  // samples per step
constexpr auto kBoneEvery = std::chrono::milliseconds(50);

int64_t unixNowNs() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
}

}  // namespace

Ros2Session::Ros2Session(const Ros2SessionOptions& options)
    : options_(options),
      ear_(options.session, *this, 0, options.rejoin_after),
      ros_(joinRos(options.ros)),
      speaker_(ros_, options.name_space),
      tf_(ros_, "tf"),
      operating_state_(ros_, options.name_space + "/operating_state", Delivery::kKept),
      events_(ros_, options.name_space + "/events", Delivery::kKept),
      status_(ros_, options.name_space + "/status", Delivery::kKept),
      bone_(ros_, options.name_space + "/bone", Delivery::kKept) {
    join();
}

void Ros2Session::join() {
    link_.emplace(options_.domain);
    ear_.join(link_->participant);
}

void Ros2Session::rejoinIfDeaf() {
    ear_.passTime();
    if (!ear_.isDeaf()) return;
    ear_.leave();
    link_.reset();  // before the new one, or Cyclone would go on with what it has of this domain
    try {
        join();
    } catch (const UserError& error) {
        ear_.leave();
        link_.reset();
        spdlog::warn("the session cannot be joined anew: {}", error.what());
    }
}

bool Ros2Session::wait(std::chrono::nanoseconds timeout) {
    if (link_) return link_->wait_set.wait(timeout);
    std::this_thread::sleep_for(timeout);
    return false;
}

void Ros2Session::step() {
    ear_.poll(kMaxNodes);
    if (link_) takeTicks();
    for (SceneModel::Change& change : ear_.model().takeChanges(SceneModel::Clock::now()).nodes)
        markers_.take(std::move(change.mesh));
    sayBone();
    rejoinIfDeaf();
}

void Ros2Session::takeTicks() {
    link_->ticks.take(kMaxTicks, [this](const dds::TicksSample& sample, const dds::SampleInfo& info) {
        if (!info.has_data || sample.session != options_.session) return;
        if (!ear_.isOurs(link_->ticks.participantOf(info.writer), info.writer)) return;
        const auto message = parseTicks(dds::payloadOf(sample));
        if (!message) return ear_.dropMalformed("ticks");
        if (message->epoch() != ear_.model().epoch()) return;
        for (const topics::Tick& tick : message->ticks()) speaker_.say(tick);
        ticks_ += uint64_t(message->ticks_size());
    });
}

void Ros2Session::beginRun() {
    scene_info_.reset();
    is_ares_ = false;
    useArm();
    speaker_.beginRun();
    said_.beginRun();
    markers_.clear();
}

void Ros2Session::hear(topics::SceneInfo&& info) {
    scene_info_ = std::move(info);
    useArm();
}

// Sliders are an ARES', and stand where the scene says that its base is.
void Ros2Session::useArm() {
    const bool is_known = is_ares_ && scene_info_ && scene_info_->has_device() &&
                          !scene_info_->p_wd_m().empty() && !scene_info_->q_wd().empty();
    if (!is_known) return speaker_.setArm({});
    speaker_.setArm(AresArm(scene_info_->device(), poseOfFields(scene_info_->p_wd_m(), scene_info_->q_wd())));
}

void Ros2Session::hear(const topics::Status& status) {
    const bool is_ares = DeviceKind(status.device().kind()) == DeviceKind::kAres;
    if (std::exchange(is_ares_, is_ares) != is_ares) useArm();
    sayEvents(said_.of(status));
    std::string text;
    if (!google::protobuf::util::MessageToJsonString(status, &text).ok()) return;
    status_.write({text.data()});
}

void Ros2Session::hear(topics::ToolState&& state) {
    sayEvents(said_.of(state));
    sayFrames(state);
    sayOperatingState(state);
}

void Ros2Session::sayFrames(const topics::ToolState& state) {
    const int64_t stamp_ns = state.stamp_ns();
    std::vector<TransformStamped> frames{
        transformOf(stamp_ns, kWorldFrame, kToolFrame, poseOfFields(state.p_wt_m(), state.q_wt())),
        transformOf(stamp_ns, kWorldFrame, kHandFrame,
                    poseOfFields(state.p_wt_device_m(), state.q_wt_device()))};
    if (scene_info_)
        frames.push_back(transformOf(stamp_ns, kWorldFrame, kVolumeFrame,
                                     poseOfFields(scene_info_->p_wv_m(), scene_info_->q_wv())));
    if (scene_info_ && !scene_info_->p_wd_m().empty() && !scene_info_->q_wd().empty())
        frames.push_back(transformOf(stamp_ns, kWorldFrame, kDeviceFrame,
                                     poseOfFields(scene_info_->p_wd_m(), scene_info_->q_wd())));
    TFMessage message{};
    pointAt(message.transforms, frames);
    tf_.write(message);
}

void Ros2Session::sayOperatingState(const topics::ToolState& state) {
    const auto device = SafetyState(state.device_state());
    const bool is_homed = device != SafetyState::kDisconnected && device != SafetyState::kConnected &&
                          device != SafetyState::kHoming;
    operating_state_.write({headerOf(state.stamp_ns(), kDeviceFrame),
                            textOf(operatingStateOf(state.device_state())), is_homed,
                            device == SafetyState::kHoming});
}

void Ros2Session::sayEvents(const std::vector<std::string>& lines) {
    for (const std::string& line : lines) events_.write({textOf(line.c_str())});
}

// Who comes late gets all nodes, whatever durability it asked for: with one topic for all of them DDS keeps
// the last parts only. Parts are far enough apart for a reader that keeps ten.
void Ros2Session::sayBone() {
    const auto now = Clock::now();
    if (now - bone_said_ < kBoneEvery) return;
    bone_said_ = now;
    if (const uint32_t readers = bone_.readersSoFar(); readers != std::exchange(bone_readers_, readers))
        markers_.tellAnew();
    MarkerPart part;
    if (markers_.takePart(part, unixNowNs())) bone_.write(part.message());
}

}  // namespace bonemill::ros2
