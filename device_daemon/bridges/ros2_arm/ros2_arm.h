// A robot, or another program's hand, as an arm: it comes as servo_cp of ROS 2 and is given the wrench as
// measured_cf (docs/howto/ros2.md). BridgeLink makes of it what it makes of every arm.
#pragma once

#include <atomic>
#include <optional>
#include <string>

#include "common/dds/participant.h"
#include "common/ros/ros_domain.h"
#include "common/ros/ros_endpoint.h"
#include "device_daemon/bridges/bridge/arm.h"
#include "device_daemon/bridges/bridge/bridge_main.h"
#include "device_daemon/bridges/ros2_arm/servo_hand.h"

namespace bonemill::bridge {

class Ros2Arm : public Arm {
  public:
    // The topics' namespace is `--device`. Throws UserError for one that is no name.
    Ros2Arm(const BridgeOptions& options, const ros2::RosOptions& ros);

    ArmDescription open(const Tell& tell) override;
    void start(ArmPeriod& period) override;
    void stop() noexcept override;

  private:
    struct Topics {
        Topics(const ros2::RosOptions& ros, const std::string& name_space);

        dds::Participant participant;
        ros2::Reader<ros2::PoseStamped> servo_cp;
        ros2::Reader<ros2::Joy> buttons;
        ros2::Writer<ros2::WrenchStamped> measured_cf;
        ros2::Writer<ros2::OperatingState> operating_state;
    };

    void run(ArmPeriod& period) noexcept;
    void hear(int64_t now_ns);
    void complain();
    void say(const ArmOrder& order, int64_t now_ns);

    const BridgeOptions options_;
    const ros2::RosOptions ros_;
    const std::string name_space_;
    std::optional<Topics> topics_;
    ServoHand hand_;
    bool has_named_frame_ = false, has_named_hand_ = false;
    const char* state_ = "";  // as said last
    int64_t said_ns_ = 0;
    std::atomic<bool> shall_end_{false};  // a lone word between two threads
    bool has_thread_ = false;
    RealtimeThread thread_;
};

}  // namespace bonemill::bridge
