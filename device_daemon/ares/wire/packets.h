// These are the packets between device_daemon (the host) and whoever has the motors: a motion controller with
// six axes (joint packets), or a program that knows a haptic arm (pose packets). docs/reference/ares_link.md
// specifies the exchange.
//
// All numbers are little-endian, floating point is IEEE 754, and every packet ends with the CRC-32 (zlib's)
// of what is before it. Units are m, N, N·m, s unless a name says otherwise. Frames are D and T
// (docs/reference/frames.md). The structs are the bytes on the wire. What comes in is believed only when it
// is well-formed. Everything is RT-safe, and any thread may call it.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace bonemill::wire {

static_assert(std::endian::native == std::endian::little);

inline constexpr uint32_t kMagic = 0x4c4d4342;  // "BCML" in memory
inline constexpr uint8_t kVersion = 1;
inline constexpr size_t kMaxPacket = 256;  // bytes

enum class PacketType : uint8_t {
    kJointState = 1,
    kJointCommand = 2,
    kDescribeRequest = 3,
    kDescribe = 4,
    kPoseState = 5,
    kPoseCommand = 6,
};

struct Header {
    uint32_t magic;
    uint8_t version;
    uint8_t type;       // PacketType
    uint16_t length;    // of the whole packet, bytes
    uint32_t session;   // chosen by the host when it asks for the description
    uint32_t sequence;  // 1, 2, ... of this direction; it may wrap
};

// The controller's inputs (bit mask); buttons follow from bit 8 on in the order of Button.
enum Input : uint32_t {
    kInputChainClosed = 1u << 0,  // the emergency stop chain is closed
    kInputEnabled = 1u << 1,      // the enabling switch is held
    kInputHomed = 1u << 2,
    kInputBrake = 1u << 3,    // the brake is on
    kInputReset = 1u << 4,    // a reset button is held
    kInputLeaving = 1u << 5,  // the controller ends in order
    kInputHoming = 1u << 6,
    kInputScriptEnded = 1u << 7,  // a scripted hand has done all of its script, and rests
};
inline constexpr int kFirstButtonInput = 8;

// What the controller complains of (bit mask of first_fault and active_faults).
enum Fault : uint32_t {
    kFaultWatchdog = 1u << 0,     // no valid command in time
    kFaultLatePackets = 1u << 1,  // the leaky bucket is full
    kFaultOverTemperature = 1u << 2,
    kFaultEncoder = 1u << 3,
    kFaultAmplifier = 1u << 4,
    kFaultOverSpeed = 1u << 5,
    kFaultEmergencyStop = 1u << 6,
    kFaultSdk = 1u << 7,  // a vendor's library returned an error
    kFaultInternal = 1u << 8,
};

// CiA 402: what the controller's state machine says, and what the host asks of it.
enum ControlWord : uint16_t {
    kControlDisable = 0x00,
    kControlShutdown = 0x06,
    kControlSwitchOn = 0x07,
    kControlEnable = 0x0F,
    kControlQuickStop = 0x02,
    kControlFaultReset = 0x80,
};
enum Mode : uint8_t { kModeNone = 0, kModeHoming = 6, kModeTorque = 10 };

enum CommandFlag : uint32_t {
    kCommandEngaged = 1u << 0,   // the hand feels haptic_server
    kCommandAttached = 1u << 1,  // haptic_server answers
};

struct JointState {
    Header header;
    uint32_t reflected_sequence;  // of the newest packet of the host
    uint32_t inputs;              // Input bits
    uint64_t controller_ns;
    uint16_t statusword;
    uint8_t mode;
    uint8_t reserved0;
    uint32_t first_fault;    // latched
    uint32_t active_faults;  // Fault bits
    uint16_t command_age_10us;
    uint16_t lost_commands;
    double q[6];        // m from the low end of the stroke
    float qd[6];        // m/s
    float force[6];     // N, given by the motors
    int32_t counts[6];  // of the encoders
    uint16_t axis_status[6];
    uint16_t axis_error[6];
    int16_t temperature_dc[6];  // 0.1 °C
    uint32_t bus_mv;
    uint32_t reserved1;
    uint32_t crc;
};

struct JointCommand {
    Header header;
    uint32_t reflected_sequence;  // of the newest packet of the controller
    uint32_t flags;               // CommandFlag bits
    uint64_t host_ns;
    uint16_t controlword;
    uint8_t mode;
    uint8_t reserved0;
    uint32_t enabling_echo;  // the inputs' enabling bit as the host has seen it
    uint32_t valid_for_us;
    uint32_t reserved1;
    float force[6];  // N
    uint32_t outputs;
    uint32_t crc;
};

// What the host can take beside what every host can.
enum Understands : uint32_t {
    kUnderstandsHandle = 1u << 0,  // a Description in place of a Describe
};

struct DescribeRequest {
    Header header;
    uint64_t host_ns;
    uint32_t watchdog_us;  // that the host wants; 0: the controller's own
    uint32_t understands;  // Understands bits
    uint32_t reserved1;
    uint32_t crc;
};

struct Describe {
    Header header;
    uint32_t firmware;
    uint32_t abilities;  // DeviceAbility bits
    uint64_t serial;
    char name[48];                  // ends with 0
    double max_force;               // N at the handle, in any direction
    double max_torque;              // N·m
    double max_stiffness;           // N/m; 0: not known
    double max_rotation_stiffness;  // N·m/rad; 0: not known
    double workspace_radius;        // m
    double max_actuator_force;      // N; 0 for pose packets
    double encoder_step;            // m; 0 for pose packets
    double stroke;                  // m; 0 for pose packets
    uint32_t watchdog_us;           // in force
    uint32_t rate_hz;               // of the states
    uint32_t kind;                  // DeviceKind
    uint32_t crc;
};

// What moves with the handle and how late it is; 0: not known. Without a mass the rest of translation is not
// known, but for delay and encoder step; without an inertia that of rotation.
struct Handle {
    double mass;             // kg
    double damping;          // N·s/m, viscous
    double inertia;          // kg·m² about T's origin
    double angular_damping;  // N·m·s/rad
    double amplifier_time;   // s: time constant of the force
    double delay;            // s: from the reading of the pose until the force that answers it begins
    double encoder_step;     // m
    double encoder_angle;    // rad
};

// A Describe that goes on: the same bytes up to `kind`. Only a host that says so gets it.
struct Description {
    Describe describe;  // its crc is 0 here
    Handle handle;
    uint32_t reserved0;
    uint32_t crc;
};

struct PoseState {
    Header header;
    uint32_t reflected_sequence;
    uint32_t inputs;
    uint64_t controller_ns;
    uint16_t statusword;
    uint8_t mode;
    uint8_t reserved0;
    uint32_t first_fault;
    uint32_t active_faults;
    uint16_t command_age_10us;
    uint16_t lost_commands;
    double p_DT[3];
    double q_DT[4];       // w, x, y, z
    float v_DT[3];        // m/s; all six NaN: the host shall differentiate
    float w_DT[3];        // rad/s, in D
    uint32_t fault_code;  // the vendor's own number
    float load;           // of the hottest motor, 0 to 1
    float applied[6];     // N, N·m on the hand; all NaN: not measured
    uint32_t reserved1;
    uint32_t crc;
};

struct PoseCommand {
    Header header;
    uint32_t reflected_sequence;
    uint32_t flags;
    uint64_t host_ns;
    uint16_t controlword;
    uint8_t mode;
    uint8_t reserved0;
    uint32_t enabling_echo;
    uint32_t valid_for_us;
    uint32_t reserved1;
    float wrench[6];  // N, N·m on the hand about T's origin, in D
    uint32_t reserved2;
    uint32_t crc;
};

static_assert(sizeof(Header) == 16);
static_assert(sizeof(JointState) == 216 && offsetof(JointState, q) == 48 && offsetof(JointState, crc) == 212);
static_assert(sizeof(JointCommand) == 80 && offsetof(JointCommand, force) == 48 &&
              offsetof(JointCommand, crc) == 76);
static_assert(sizeof(DescribeRequest) == 40 && offsetof(DescribeRequest, crc) == 36);
static_assert(sizeof(Describe) == 160 && offsetof(Describe, name) == 32 && offsetof(Describe, crc) == 156);
static_assert(sizeof(Handle) == 64 && sizeof(Description) == 232 && offsetof(Description, handle) == 160 &&
              offsetof(Description, crc) == 228);
static_assert(sizeof(PoseState) == 168 && offsetof(PoseState, p_DT) == 48 && offsetof(PoseState, crc) == 164);
static_assert(sizeof(PoseCommand) == 80 && offsetof(PoseCommand, wrench) == 48 &&
              offsetof(PoseCommand, crc) == 76);

// These are the packets of the two kinds of device.
struct JointPackets {
    using State = JointState;
    using Command = JointCommand;
};
struct PosePackets {
    using State = PoseState;
    using Command = PoseCommand;
};

// Fills in header and CRC, after everything else.
template <class Packet>
void seal(Packet& packet, uint32_t session, uint32_t sequence) noexcept;

// Returns the packet if the bytes are exactly one of this type: length, magic, version, type and CRC are
// right, every number is finite (but for those that may be missing as NaN, all of them at once), and text
// ends.
template <class Packet>
std::optional<Packet> open(std::span<const std::byte> bytes) noexcept;

// The same whatever its numbers and text are; isSound() says of those what open() asks of them.
template <class Packet>
std::optional<Packet> openWhole(std::span<const std::byte> bytes) noexcept;
bool isSound(const JointState& state) noexcept;
bool isSound(const PoseState& state) noexcept;

// Returns the type that the header claims; nothing if there is no header of ours.
std::optional<PacketType> claimedType(std::span<const std::byte> bytes) noexcept;

template <class Packet>
std::span<const std::byte> bytesOf(const Packet& packet) noexcept {
    return std::as_bytes(std::span<const Packet, 1>(&packet, 1));
}

// Tells whether this sequence number is the newer one: ahead by 1 to 2^31 - 1, modulo 2^32.
constexpr bool isNewer(uint32_t sequence, uint32_t than) noexcept {
    return sequence != than && sequence - than < 0x80000000u;
}

}  // namespace bonemill::wire
