#include "device_daemon/bridges/ros2_arm/servo_hand.h"

#include <string_view>

namespace bonemill::bridge {
namespace {

bool isOfDevice(const char* frame) noexcept {
    const std::string_view name = frame ? frame : "";
    return name.empty() || name == ros2::kDeviceFrame;
}

bool isPressed(const ros2::Joy& joy, uint32_t place) noexcept {
    return place < joy.buttons._length && joy.buttons._buffer[place] != 0;
}

}  // namespace

bool ServoHand::take(const ros2::PoseStamped& message, uint64_t writer, int64_t now_ns) noexcept {
    if (!isOfDevice(message.header.frame_id)) {
        ++foreign_frames_;
        return false;
    }
    if (isFresh(now_ns) && writer != writer_) {
        ++foreign_hands_;
        return false;
    }
    writer_ = writer;
    heard_ns_ = now_ns;
    X_DT_ = ros2::poseOf(message);
    return true;
}

void ServoHand::take(const ros2::Joy& message, int64_t now_ns) noexcept {
    pressed_ns_ = now_ns;
    buttons_ = (isPressed(message, kRemovePlace) ? kButtonRemove : 0u) |
               (isPressed(message, kAddPlace) ? kButtonAdd : 0u);
    has_enabling_ |= message.buttons._length > kEnablePlace;
    is_enabling_ = isPressed(message, kEnablePlace);
}

ArmReading ServoHand::reading(int64_t now_ns) const noexcept {
    const bool is_known = writer_ != 0, is_pressed = now_ns - pressed_ns_ <= kPressedNs;
    ArmReading reading;
    reading.is_valid = !is_known || isFresh(now_ns);
    reading.X_DT = X_DT_;
    reading.buttons = is_pressed ? buttons_ : 0;
    reading.is_homed = reading.is_powered = is_known;
    reading.is_enabled = !has_enabling_ || (is_enabling_ && is_pressed);
    return reading;
}

}  // namespace bonemill::bridge
