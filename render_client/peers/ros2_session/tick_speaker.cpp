#include "render_client/peers/ros2_session/tick_speaker.h"

#include <array>
#include <vector>

#include "common/base/units.h"
#include "common/ros/ros_messages.h"

namespace bonemill::ros2 {
namespace {

constexpr std::array<const char*, kLegCount> kSliderNames = {"slider_1", "slider_2", "slider_3",
                                                             "slider_4", "slider_5", "slider_6"};
constexpr int64_t kPauseNs = 50 * kNsPerMillisecond;

Eigen::Vector3d vectorOfFields(const google::protobuf::RepeatedField<double>& v) {
    return {v[0], v[1], v[2]};
}

}  // namespace

Pose poseOfFields(const google::protobuf::RepeatedField<double>& p,
                  const google::protobuf::RepeatedField<double>& q) {
    return {vectorOfFields(p), {q[0], q[1], q[2], q[3]}};
}

std::optional<HandVelocity::Motion> HandVelocity::take(const Pose& X_WT, int64_t stamp_ns) {
    const bool goes_on = !moments_.empty() && stamp_ns > moments_.back().stamp_ns &&
                         stamp_ns - moments_.back().stamp_ns <= kPauseNs;
    if (!goes_on) moments_.clear();
    moments_.push_back({X_WT, stamp_ns});
    if (moments_.size() == 1) return std::nullopt;
    if (moments_.size() > kSpan + 1) moments_.pop_front();
    const Moment& before = moments_.front();
    const double elapsed = double(stamp_ns - before.stamp_ns) / double(kNsPerSecond);
    return Motion{(X_WT.position - before.X_WT.position) / elapsed,
                  logRotation(X_WT.rotation * before.X_WT.rotation.conjugate()) / elapsed};
}

TickSpeaker::TickSpeaker(const dds::Participant& participant, const std::string& name_space)
    : measured_cp_(participant, name_space + "/measured_cp"),
      setpoint_cp_(participant, name_space + "/setpoint_cp"),
      measured_cv_(participant, name_space + "/measured_cv"),
      measured_cf_(participant, name_space + "/measured_cf"),
      measured_js_(participant, name_space + "/measured_js") {
    for (const char* name : kSliderNames) slider_names_.push_back(textOf(name));
}

void TickSpeaker::say(const topics::Tick& tick) {
    if (last_tick_ && tick.tick() > *last_tick_) missing_ += tick.tick() - *last_tick_ - 1;
    last_tick_ = tick.tick();
    const int64_t stamp_ns = tick.stamp_ns();
    const Pose X_WT_device = poseOfFields(tick.p_wt_device_m(), tick.q_wt_device());
    measured_cp_.write(poseOf(stamp_ns, kWorldFrame, X_WT_device));
    setpoint_cp_.write(poseOf(stamp_ns, kWorldFrame, poseOfFields(tick.p_wt_m(), tick.q_wt())));
    measured_cf_.write(
        wrenchOf(stamp_ns, kWorldFrame, {vectorOfFields(tick.force_n()), vectorOfFields(tick.torque_nm())}));
    const auto motion = velocity_.take(X_WT_device, stamp_ns);
    if (motion) measured_cv_.write(twistOf(stamp_ns, kWorldFrame, motion->v_WT, motion->w_WT));
    sayJoints(stamp_ns, X_WT_device, motion);
}

// How hard the motors push is not among what a session tells: no effort is said.
void TickSpeaker::sayJoints(int64_t stamp_ns, const Pose& X_WT,
                            const std::optional<AresArm::Motion>& motion) {
    const auto joints = arm_ ? arm_->jointsAt(X_WT, motion) : std::nullopt;
    if (!joints) return;
    std::vector<double> positions(joints->positions.begin(), joints->positions.end()), velocities;
    if (joints->velocities) velocities.assign(joints->velocities->begin(), joints->velocities->end());
    JointState message{.header = headerOf(stamp_ns, kDeviceFrame)};
    pointAt(message.name, slider_names_);
    pointAt(message.position, positions);
    pointAt(message.velocity, velocities);
    measured_js_.write(message);
}

void TickSpeaker::beginRun() {
    last_tick_.reset();
    velocity_ = {};
}

}  // namespace bonemill::ros2
