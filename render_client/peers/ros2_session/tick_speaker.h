// Tells every tick in CRTK's words: measured_cp, where the hand really holds the tool; setpoint_cp, the
// simulated tool that the bone holds back; measured_cv, the hand's velocity; measured_cf, the wrench on the
// hand, all in W; measured_js, the sliders of an ARES. The stamp is when the tick began. It is for one
// thread.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/pose.h"
#include "common/ros/ros_endpoint.h"
#include "proto/topics.pb.h"
#include "render_client/peers/ros2_session/arm_joints.h"

namespace bonemill::ros2 {

// The velocity of a handle by its poses: their difference over kSpan ticks, which is half of that late.
class HandVelocity {
  public:
    static constexpr size_t kSpan = 8;  // at 1000 Hz of positions in steps of 10 µm: steps of 1.3 mm/s

    using Motion = AresArm::Motion;
    // Nothing before there are two poses, and after a pause.
    std::optional<Motion> take(const Pose& X_WT, int64_t stamp_ns);

  private:
    struct Moment {
        Pose X_WT;
        int64_t stamp_ns;
    };
    std::deque<Moment> moments_;
};

class TickSpeaker {
  public:
    TickSpeaker(const dds::Participant& participant, const std::string& name_space);

    void say(const topics::Tick& tick);
    // The hand holds this one from now on, or another device.
    void setArm(std::optional<AresArm> arm) { arm_ = std::move(arm); }
    // Of the ticks that were said, the numbers left out in between: the server or the network lost them.
    uint64_t missing() const noexcept { return missing_; }
    // Another run of the server begins.
    void beginRun();

  private:
    void sayJoints(int64_t stamp_ns, const Pose& X_WT, const std::optional<AresArm::Motion>& motion);

    Writer<PoseStamped> measured_cp_, setpoint_cp_;
    Writer<TwistStamped> measured_cv_;
    Writer<WrenchStamped> measured_cf_;
    Writer<JointState> measured_js_;
    std::vector<char*> slider_names_;
    std::optional<AresArm> arm_;
    HandVelocity velocity_;
    std::optional<uint64_t> last_tick_;
    uint64_t missing_ = 0;
};

// The pose of three and four numbers of a message that was checked.
Pose poseOfFields(const google::protobuf::RepeatedField<double>& p,
                  const google::protobuf::RepeatedField<double>& q);

}  // namespace bonemill::ros2
