// What nodes of ROS 2 say of the hand: where it is to be (servo_cp) and what is pressed (buttons). It decides
// whose word counts and for how long; what a pose is worth is device_daemon's to judge, as of every arm:
// numbers that are none, rotations that are none and jumps stop the hand there (driver/udp_pose_device.h).
//
// It is for one thread, RT-safe, and does not know DDS: time comes in as a parameter (CLOCK_MONOTONIC ns).
#pragma once

#include <cstdint>

#include "common/ros/ros_messages.h"
#include "device_daemon/bridges/bridge/arm.h"

namespace bonemill::bridge {

class ServoHand {
  public:
    // A pose counts for so long. What is older is an arm that does not answer; BridgeLink::kTroubleNs later
    // it is a fault.
    static constexpr int64_t kFreshNs = 30'000'000;
    // So do buttons, which nodes repeat: a pedal under a node that has died comes up.
    static constexpr int64_t kPressedNs = 500'000'000;

    // Places of sensor_msgs/Joy.buttons. Who has ever said a third gives force only while it is held.
    enum ButtonPlace : uint32_t { kRemovePlace = 0, kAddPlace = 1, kEnablePlace = 2 };

    // `writer` says who wrote it, and is not 0. Poses are in D: the header's frame is bonemill_device or
    // empty. The first writer is believed alone until it is silent for kFreshNs. False: the pose does not
    // count.
    bool take(const ros2::PoseStamped& message, uint64_t writer, int64_t now_ns) noexcept;
    // Buttons count of any writer, the last word of it.
    void take(const ros2::Joy& message, int64_t now_ns) noexcept;

    // Before the first pose the hand is where D begins, and not homed: nothing is wrong, and nothing is
    // believed.
    ArmReading reading(int64_t now_ns) const noexcept;
    bool isFresh(int64_t now_ns) const noexcept { return writer_ != 0 && now_ns - heard_ns_ <= kFreshNs; }
    // How many poses did not count because of their frame, or because another one leads the hand.
    uint64_t foreignFrames() const noexcept { return foreign_frames_; }
    uint64_t foreignHands() const noexcept { return foreign_hands_; }

  private:
    Pose X_DT_;
    uint64_t writer_ = 0;  // who leads the hand; 0: nobody yet
    int64_t heard_ns_ = 0, pressed_ns_ = 0;
    uint32_t buttons_ = 0;  // Button bits
    bool has_enabling_ = false, is_enabling_ = false;
    uint64_t foreign_frames_ = 0, foreign_hands_ = 0;
};

}  // namespace bonemill::bridge
