#include "common/ros/ros_messages.h"

#include <dds/dds.h>

#include "common/base/units.h"

namespace bonemill::ros2 {
namespace {

template <class Vector>
Vector vectorOf(const Eigen::Vector3d& v) noexcept {
    return {v.x(), v.y(), v.z()};
}

geometry_msgs_msg_dds__Quaternion_ quaternionOf(const Eigen::Quaterniond& q) noexcept {
    return {q.x(), q.y(), q.z(), q.w()};
}

}  // namespace

template <>
const dds_topic_descriptor_t* typeOf<String>() {
    return &std_msgs_msg_dds__String__desc;
}
template <>
const dds_topic_descriptor_t* typeOf<PoseStamped>() {
    return &geometry_msgs_msg_dds__PoseStamped__desc;
}
template <>
const dds_topic_descriptor_t* typeOf<TwistStamped>() {
    return &geometry_msgs_msg_dds__TwistStamped__desc;
}
template <>
const dds_topic_descriptor_t* typeOf<WrenchStamped>() {
    return &geometry_msgs_msg_dds__WrenchStamped__desc;
}
template <>
const dds_topic_descriptor_t* typeOf<TFMessage>() {
    return &tf2_msgs_msg_dds__TFMessage__desc;
}
template <>
const dds_topic_descriptor_t* typeOf<JointState>() {
    return &sensor_msgs_msg_dds__JointState__desc;
}
template <>
const dds_topic_descriptor_t* typeOf<Joy>() {
    return &sensor_msgs_msg_dds__Joy__desc;
}
template <>
const dds_topic_descriptor_t* typeOf<MarkerArray>() {
    return &visualization_msgs_msg_dds__MarkerArray__desc;
}
template <>
const dds_topic_descriptor_t* typeOf<OperatingState>() {
    return &crtk_msgs_msg_dds__OperatingState__desc;
}

char* textOf(const char* text) noexcept {
    return const_cast<char*>(text);
}

Header headerOf(int64_t stamp_ns, const char* frame) noexcept {
    return {{int32_t(stamp_ns / kNsPerSecond), uint32_t(stamp_ns % kNsPerSecond)}, textOf(frame)};
}

PoseStamped poseOf(int64_t stamp_ns, const char* frame, const Pose& X_FT) noexcept {
    return {headerOf(stamp_ns, frame), {vectorOf<Point>(X_FT.position), quaternionOf(X_FT.rotation)}};
}

TwistStamped twistOf(int64_t stamp_ns, const char* frame, const Eigen::Vector3d& v,
                     const Eigen::Vector3d& w) noexcept {
    using Vector = geometry_msgs_msg_dds__Vector3_;
    return {headerOf(stamp_ns, frame), {vectorOf<Vector>(v), vectorOf<Vector>(w)}};
}

WrenchStamped wrenchOf(int64_t stamp_ns, const char* frame, const Wrench& wrench) noexcept {
    using Vector = geometry_msgs_msg_dds__Vector3_;
    return {headerOf(stamp_ns, frame), {vectorOf<Vector>(wrench.force), vectorOf<Vector>(wrench.torque)}};
}

TransformStamped transformOf(int64_t stamp_ns, const char* parent, const char* child,
                             const Pose& X_PC) noexcept {
    using Vector = geometry_msgs_msg_dds__Vector3_;
    return {headerOf(stamp_ns, parent),
            textOf(child),
            {vectorOf<Vector>(X_PC.position), quaternionOf(X_PC.rotation)}};
}

Pose poseOf(const PoseStamped& message) noexcept {
    const auto& [p, q] = message.pose;
    return {{p.x, p.y, p.z}, {q.w, q.x, q.y, q.z}};
}

}  // namespace bonemill::ros2
