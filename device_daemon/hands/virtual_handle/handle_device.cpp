#include "device_daemon/hands/virtual_handle/handle_device.h"

namespace bonemill {

DeviceCapabilities handleCapabilities(DeviceKind kind, std::string_view name) noexcept {
    DeviceCapabilities device{};
    name.copy(device.name, sizeof device.name - 1);
    device.kind = static_cast<uint32_t>(kind);
    device.abilities = kAbilityForce | kAbilityTorque | kAbilityOrientation | kAbilitySimulated;
    device.max_force = kMaxHandleForce;
    device.max_torque = kMaxHandleTorque;
    device.max_stiffness = VirtualHandle::kMaxStiffness;
    device.max_rotation_stiffness = VirtualHandle::kMaxRotationStiffness;
    device.workspace_radius = VirtualHandle::kReach;
    return device;
}

Wrench feltWrench(const DeviceOrder& order) noexcept {
    return order.wrench_hand_D.isFinite() ? order.wrench_hand_D : Wrench{};
}

DeviceReading readingOf(const VirtualHandle& handle, const Wrench& felt_D, uint32_t buttons) noexcept {
    return {.X_DT = handle.pose(),
            .v_DT = handle.v_DT(),
            .w_DT = handle.w_DT(),
            .buttons = buttons,
            .status = kStatusPowered | kStatusCalibrated | kStatusDriving,
            .has_applied = true,
            .applied_D = felt_D};
}

}  // namespace bonemill
