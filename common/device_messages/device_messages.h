// device_daemon and haptic_server say this to each other through shared memory.
//
// The frames are D, the device's base, and T, the tool frame of the handle. Units are m, N, N·m; stamps are
// CLOCK_MONOTONIC ns of this machine. Everything here is RT-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace bonemill {

struct DeviceSample {
    uint64_t sequence;  // 1, 2, ...: set by the link, continues when a daemon is restarted
    int64_t stamp_ns;   // when the joints were read
    double p_DT[3];
    double q_DT[4];    // w, x, y, z
    uint32_t buttons;  // Button bits
    uint32_t flags;    // DeviceFlag bits
};

struct WrenchCommand {
    uint64_t sequence;          // 1, 2, ...: set by the link
    int64_t stamp_ns;           // when the wrench was computed
    double f_hand_D[3];         // on the hand
    double t_hand_D[3];         // on the hand, about the handle's tool point
    uint64_t answers_sequence;  // of the DeviceSample this wrench answers
    uint64_t reserved;
};

enum Button : uint32_t {
    kButtonRemove = 1u << 0,  // the pedal: the burr removes bone
    kButtonAdd = 1u << 1,     // the burr adds material
};

enum DeviceFlag : uint32_t {
    kDeviceFlagSimulated = 1u << 0,     // no hand and no motor behind this sample
    kDeviceFlagForceLimited = 1u << 1,  // the last wrench was reduced by the device's safety
    kDeviceFlagLeaving = 1u << 2,       // last sample: the daemon shuts down in order, nothing is wrong
};

static_assert(std::is_trivially_copyable_v<DeviceSample> && std::is_standard_layout_v<DeviceSample>);
static_assert(sizeof(DeviceSample) == 80 && offsetof(DeviceSample, p_DT) == 16 &&
              offsetof(DeviceSample, q_DT) == 40 && offsetof(DeviceSample, buttons) == 72 &&
              offsetof(DeviceSample, flags) == 76);
static_assert(std::is_trivially_copyable_v<WrenchCommand> && std::is_standard_layout_v<WrenchCommand>);
static_assert(sizeof(WrenchCommand) == 80 && offsetof(WrenchCommand, f_hand_D) == 16 &&
              offsetof(WrenchCommand, t_hand_D) == 40 && offsetof(WrenchCommand, answers_sequence) == 64 &&
              offsetof(WrenchCommand, reserved) == 72);

// |q| may differ from 1 by so much, which is far above rounding and far below what a torn or
// random quaternion shows.
inline constexpr double kQuaternionNormTolerance = 1e-3;
// No device of this world reaches farther from its base than this (m). It refuses garbage that is
// finite by chance.
inline constexpr double kLargestDeviceReach = 10.0;

// Tells whether the server may act on it: it is finite, a rotation, and within reach.
bool isPlausible(const DeviceSample& sample) noexcept;
// Tells whether the daemon may act on it: it is finite. Limits are the business of the device's safety.
bool isPlausible(const WrenchCommand& command) noexcept;

}  // namespace bonemill
