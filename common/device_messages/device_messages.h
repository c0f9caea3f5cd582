// device_daemon and haptic_server say this to each other through shared memory (layout 6).
//
// The frames are D, the device's base, and T, the tool frame of the handle. Units are m, N, N·m; stamps are
// CLOCK_MONOTONIC ns of this machine. Everything here is RT-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "common/device_messages/device_state.h"

namespace bonemill {

struct DeviceSample {
    uint64_t sequence;  // 1, 2, ...: set by the link, continues when a daemon is restarted
    int64_t stamp_ns;   // when the sensors were read
    double p_DT[3];
    double q_DT[4];        // w, x, y, z
    double v_DT[3];        // m/s
    double w_DT[3];        // rad/s, in D
    uint32_t buttons;      // Button bits
    uint32_t flags;        // DeviceFlag bits
    uint32_t state;        // SafetyState
    uint32_t stop_cause;   // StopCause: the first one since the last reset
    uint32_t fault_code;   // the device's own number, with StopCause::kDeviceFault
    uint32_t reset_count;  // how often the device was reset
    // It was measured with this scene's device and scale (SceneNotice::revision); 0 before any.
    uint32_t scene_revision;
    // Counts how often a handle that is only numbers was put somewhere, without a way there: with a new
    // number the simulated tool goes along, if there is no bone.
    uint32_t placements;
};

struct WrenchCommand {
    uint64_t sequence;          // 1, 2, ...: set by the link
    int64_t stamp_ns;           // when the wrench was computed
    double f_hand_D[3];         // on the hand
    double t_hand_D[3];         // on the hand, about the handle's tool point
    uint64_t answers_sequence;  // of the DeviceSample this wrench answers
    uint32_t reset_orders;      // counts a user's orders to reset the device; a new number is a new order
    uint32_t scene_revision;    // as in DeviceSample: each side ignores what belongs to another scene
};

// Which hand the server wants.
enum class HandChoice : uint32_t {
    kOwn = 0,      // the device that the daemon was started with
    kPointer = 1,  // the mouse in a viewer, in place of a scripted hand
};

// The server says so which scene is in force. The daemon reads the file, and goes by it only if it is the one
// that the server has read.
struct SceneNotice {
    uint64_t hash;      // sceneHashOf()
    uint32_t revision;  // 1, 2, ...: set by the link; a new number is a new scene, or a server started anew
    // Counts the beginnings and the ends of attempts: odd while one is under way. Set by the link.
    uint32_t attempt_changes;
    uint64_t epoch;         // that viewers know the server's run by; 0: not told
    uint32_t hand;          // HandChoice; a daemon whose own hand is not a scripted one stays with it
    uint32_t hand_repeats;  // counts the orders that a scripted hand does its script anew. Set by the link.
    char path[1024];        // absolute; ends with 0
};

// This is what moves with the handle, and how late the device is. The server fits the coupling to it
// (haptic_server/core/tick/hand_side.h). Without a mass the rest of translation is not known, without an
// inertia that of rotation.
struct HandleDynamics {
    double mass;             // kg
    double damping;          // N·s/m, viscous
    double inertia;          // kg·m² about the handle's tool point, the least of all axes
    double angular_damping;  // N·m·s/rad
    double amplifier_time;   // s: time constant of the force after its command
    double delay;            // s: from the reading of the encoders until the wrench that answers it begins
    double encoder_step;     // m: readings are wrong by half of it
    double encoder_angle;    // rad: the same for the angles
};

// It says what kind of device there is, and is written by the daemon whenever another one is there. The
// server adapts to it.
struct DeviceCapabilities {
    char name[48];                  // ends with 0: "ARES emulator"
    uint32_t kind;                  // DeviceKind
    uint32_t abilities;             // DeviceAbility bits
    double max_force;               // N that it can give in any direction; 0 without force
    double max_torque;              // N·m; 0 without torque
    double max_stiffness;           // N/m that it holds without shaking; 0: not known
    double max_rotation_stiffness;  // N·m/rad; 0: not known
    double workspace_radius;        // m around D's origin
    HandleDynamics handle = {};
};

enum Button : uint32_t {
    kButtonRemove = 1u << 0,  // the pedal: the burr removes bone
    kButtonAdd = 1u << 1,     // the burr adds material
};

enum DeviceFlag : uint32_t {
    kDeviceFlagSimulated = 1u << 0,     // no hand and no motor behind this sample
    kDeviceFlagForceLimited = 1u << 1,  // the last wrench was reduced by the device's safety
    kDeviceFlagLeaving = 1u << 2,       // last sample: the daemon shuts down in order, nothing is wrong
    kDeviceFlagEnabled = 1u << 3,       // the enabling switch is held
    kDeviceFlagCalibrated = 1u << 4,    // positions count from a zero that the device has found
    kDeviceFlagForceWaits =
        1u << 5,  // it does not engage because the wrench is not small: move the tool away
    kDeviceFlagScriptEnded = 1u << 6,  // a scripted hand has done all of its script, and rests
};

enum class DeviceKind : uint32_t {
    kUnknown = 0,
    kAres = 1,
    kForceDimension = 2,
    kTouch = 3,
    kHaply = 4,
    kBridge = 5,   // a user's own program
    kPointer = 6,  // the mouse in a viewer
    kSpaceMouse = 7,
    kGamepad = 8,
};
inline constexpr uint32_t kDeviceKindCount = 9;

enum DeviceAbility : uint32_t {
    kAbilityForce = 1u << 0,           // the hand feels force
    kAbilityTorque = 1u << 1,          // the hand feels torque
    kAbilityOrientation = 1u << 2,     // it senses how the handle is turned
    kAbilityEnablingSwitch = 1u << 3,  // it has a switch that must be held
    kAbilitySimulated = 1u << 4,       // no hand and no motor
};

static_assert(std::is_trivially_copyable_v<DeviceSample> && std::is_standard_layout_v<DeviceSample>);
static_assert(sizeof(DeviceSample) == 152 && offsetof(DeviceSample, p_DT) == 16 &&
              offsetof(DeviceSample, q_DT) == 40 && offsetof(DeviceSample, v_DT) == 72 &&
              offsetof(DeviceSample, w_DT) == 96 && offsetof(DeviceSample, buttons) == 120 &&
              offsetof(DeviceSample, flags) == 124 && offsetof(DeviceSample, state) == 128 &&
              offsetof(DeviceSample, stop_cause) == 132 && offsetof(DeviceSample, fault_code) == 136 &&
              offsetof(DeviceSample, reset_count) == 140 && offsetof(DeviceSample, scene_revision) == 144 &&
              offsetof(DeviceSample, placements) == 148);
static_assert(std::is_trivially_copyable_v<WrenchCommand> && std::is_standard_layout_v<WrenchCommand>);
static_assert(sizeof(WrenchCommand) == 80 && offsetof(WrenchCommand, f_hand_D) == 16 &&
              offsetof(WrenchCommand, t_hand_D) == 40 && offsetof(WrenchCommand, answers_sequence) == 64 &&
              offsetof(WrenchCommand, reset_orders) == 72 && offsetof(WrenchCommand, scene_revision) == 76);
static_assert(std::is_trivially_copyable_v<SceneNotice> && std::is_standard_layout_v<SceneNotice>);
static_assert(sizeof(SceneNotice) == 1056 && offsetof(SceneNotice, attempt_changes) == 12 &&
              offsetof(SceneNotice, epoch) == 16 && offsetof(SceneNotice, hand) == 24 &&
              offsetof(SceneNotice, hand_repeats) == 28 && offsetof(SceneNotice, path) == 32);
static_assert(std::is_trivially_copyable_v<DeviceCapabilities> &&
              std::is_standard_layout_v<DeviceCapabilities>);
static_assert(sizeof(HandleDynamics) == 64 && sizeof(DeviceCapabilities) == 160 &&
              offsetof(DeviceCapabilities, kind) == 48 && offsetof(DeviceCapabilities, max_force) == 56 &&
              offsetof(DeviceCapabilities, workspace_radius) == 88 &&
              offsetof(DeviceCapabilities, handle) == 96);

// |q| may differ from 1 by so much, which is far above rounding and far below what a torn or
// random quaternion shows.
inline constexpr double kQuaternionNormTolerance = 1e-3;
// No device of this world reaches farther from its base than this (m). It refuses garbage that is
// finite by chance.
inline constexpr double kMaxDeviceReach = 10.0;
// And none is so fast (m/s, rad/s).
inline constexpr double kMaxDeviceSpeed = 100.0;
inline constexpr double kMaxDeviceSpin = 1000.0;

// Tells whether the server may act on it: it is finite, a rotation, within reach, and in a state that there
// is.
bool isPlausible(const DeviceSample& sample) noexcept;
// Tells whether a plausible sample can be this device's: no device goes twice as far from its base as it
// says, unless it says nothing.
bool isWithinReach(const DeviceSample& sample, const DeviceCapabilities& device) noexcept;
// Tells whether the daemon may act on it: it is finite. Limits are the business of the device's safety.
bool isPlausible(const WrenchCommand& command) noexcept;
// Tells whether the server may adapt to it: its text ends, its kind is known, and its figures are finite and
// not negative.
bool isPlausible(const DeviceCapabilities& capabilities) noexcept;
// Tells whether the daemon may look for the file: its path is absolute, ends, and can stand in a log. The
// hand is one that there is.
bool isPlausible(const SceneNotice& notice) noexcept;

}  // namespace bonemill
