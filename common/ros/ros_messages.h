// The messages of ROS 2 that bonemill says and hears (proto/ros2.idl), and how ours become theirs: m, N, N·m,
// rad, s, their quaternions x, y, z, w. For any thread.
//
// What a message points to must outlive it: texts are of static storage.
#pragma once

#include <ros2.h>

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "common/geometry/pose.h"

namespace bonemill::ros2 {

using Header = std_msgs_msg_dds__Header_;
using String = std_msgs_msg_dds__String_;
using Point = geometry_msgs_msg_dds__Point_;
using PoseStamped = geometry_msgs_msg_dds__PoseStamped_;
using TwistStamped = geometry_msgs_msg_dds__TwistStamped_;
using WrenchStamped = geometry_msgs_msg_dds__WrenchStamped_;
using TransformStamped = geometry_msgs_msg_dds__TransformStamped_;
using TFMessage = tf2_msgs_msg_dds__TFMessage_;
using JointState = sensor_msgs_msg_dds__JointState_;
using Joy = sensor_msgs_msg_dds__Joy_;
using Marker = visualization_msgs_msg_dds__Marker_;
using MarkerArray = visualization_msgs_msg_dds__MarkerArray_;
using OperatingState = crtk_msgs_msg_dds__OperatingState_;

template <class Message>
const dds_topic_descriptor_t* typeOf();

// The frames that headers name (docs/reference/frames.md).
inline constexpr char kWorldFrame[] = "bonemill_world";    // W
inline constexpr char kVolumeFrame[] = "bonemill_volume";  // V
inline constexpr char kToolFrame[] = "bonemill_tool";      // T of the simulated tool
inline constexpr char kHandFrame[] = "bonemill_hand";      // T where the hand really holds it
inline constexpr char kDeviceFrame[] = "bonemill_device";  // D

// Cyclone's C types have no const; what is written is not changed.
char* textOf(const char* text) noexcept;

Header headerOf(int64_t stamp_ns, const char* frame) noexcept;
// Of poses, X_FT in the frame F.
PoseStamped poseOf(int64_t stamp_ns, const char* frame, const Pose& X_FT) noexcept;
TwistStamped twistOf(int64_t stamp_ns, const char* frame, const Eigen::Vector3d& v,
                     const Eigen::Vector3d& w) noexcept;
WrenchStamped wrenchOf(int64_t stamp_ns, const char* frame, const Wrench& wrench) noexcept;
TransformStamped transformOf(int64_t stamp_ns, const char* parent, const char* child,
                             const Pose& X_PC) noexcept;

// The rotation is as it came, of any length.
Pose poseOf(const PoseStamped& message) noexcept;

// Lets a sequence of a message point at these elements; nothing is copied.
template <class Sequence, class Element>
void pointAt(Sequence& sequence, std::vector<Element>& elements) noexcept {
    sequence._buffer = elements.data();
    sequence._length = sequence._maximum = uint32_t(elements.size());
    sequence._release = false;
}

}  // namespace bonemill::ros2
