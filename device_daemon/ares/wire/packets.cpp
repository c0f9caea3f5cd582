#include "device_daemon/ares/wire/packets.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace bonemill::wire {
namespace {

template <class Packet>
constexpr PacketType kTypeOf{};
template <>
constexpr PacketType kTypeOf<JointState> = PacketType::kJointState;
template <>
constexpr PacketType kTypeOf<JointCommand> = PacketType::kJointCommand;
template <>
constexpr PacketType kTypeOf<DescribeRequest> = PacketType::kDescribeRequest;
template <>
constexpr PacketType kTypeOf<Describe> = PacketType::kDescribe;
template <>
constexpr PacketType kTypeOf<Description> = PacketType::kDescribe;
template <>
constexpr PacketType kTypeOf<PoseState> = PacketType::kPoseState;
template <>
constexpr PacketType kTypeOf<PoseCommand> = PacketType::kPoseCommand;

uint32_t crcOf(std::span<const std::byte> bytes) noexcept {
    return uint32_t(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

template <class T, size_t N>
bool areFinite(const T (&values)[N]) noexcept {
    return std::all_of(values, values + N, [](T x) { return std::isfinite(x); });
}

template <class T, size_t N>
bool areMissing(const T (&values)[N]) noexcept {
    return std::all_of(values, values + N, [](T x) { return std::isnan(x); });
}

bool isSound(const JointCommand& command) noexcept {
    return areFinite(command.force);
}

bool isSound(const DescribeRequest&) noexcept {
    return true;
}

bool isSound(const Describe& d) noexcept {
    const double figures[] = {
        d.max_force,        d.max_torque,         d.max_stiffness, d.max_rotation_stiffness,
        d.workspace_radius, d.max_actuator_force, d.encoder_step,  d.stroke};
    const bool text_ends = std::find(d.name, std::end(d.name), '\0') != std::end(d.name);
    return text_ends && areFinite(figures);
}

bool isSound(const Description& d) noexcept {
    const Handle& h = d.handle;
    const double figures[] = {h.mass,           h.damping, h.inertia,      h.angular_damping,
                              h.amplifier_time, h.delay,   h.encoder_step, h.encoder_angle};
    return isSound(d.describe) && areFinite(figures);
}

bool isSound(const PoseCommand& command) noexcept {
    return areFinite(command.wrench);
}

Header& headerOf(Description& packet) noexcept {
    return packet.describe.header;
}
template <class Packet>
Header& headerOf(Packet& packet) noexcept {
    return packet.header;
}

}  // namespace

bool isSound(const JointState& s) noexcept {
    return areFinite(s.q) && areFinite(s.qd) && areFinite(s.force);
}

bool isSound(const PoseState& s) noexcept {
    const bool has_no_motion = areMissing(s.v_DT) && areMissing(s.w_DT);
    const bool has_motion = areFinite(s.v_DT) && areFinite(s.w_DT);
    return areFinite(s.p_DT) && areFinite(s.q_DT) && (has_motion || has_no_motion) && std::isfinite(s.load) &&
           (areFinite(s.applied) || areMissing(s.applied));
}

template <class Packet>
void seal(Packet& packet, uint32_t session, uint32_t sequence) noexcept {
    headerOf(packet) = {.magic = kMagic,
                        .version = kVersion,
                        .type = uint8_t(kTypeOf<Packet>),
                        .length = uint16_t(sizeof(Packet)),
                        .session = session,
                        .sequence = sequence};
    packet.crc = crcOf(bytesOf(packet).first(offsetof(Packet, crc)));
}

template <class Packet>
std::optional<Packet> openWhole(std::span<const std::byte> bytes) noexcept {
    if (bytes.size() != sizeof(Packet) || claimedType(bytes) != kTypeOf<Packet>) return std::nullopt;
    Packet packet;
    std::memcpy(&packet, bytes.data(), sizeof(Packet));
    if (headerOf(packet).length != sizeof(Packet)) return std::nullopt;
    if (packet.crc != crcOf(bytes.first(offsetof(Packet, crc)))) return std::nullopt;
    return packet;
}

template <class Packet>
std::optional<Packet> open(std::span<const std::byte> bytes) noexcept {
    const auto packet = openWhole<Packet>(bytes);
    return packet && isSound(*packet) ? packet : std::nullopt;
}

std::optional<PacketType> claimedType(std::span<const std::byte> bytes) noexcept {
    Header header;
    if (bytes.size() < sizeof(header)) return std::nullopt;
    std::memcpy(&header, bytes.data(), sizeof(header));
    if (header.magic != kMagic || header.version != kVersion) return std::nullopt;
    return PacketType(header.type);
}

template void seal(JointState&, uint32_t, uint32_t) noexcept;
template void seal(JointCommand&, uint32_t, uint32_t) noexcept;
template void seal(DescribeRequest&, uint32_t, uint32_t) noexcept;
template void seal(Describe&, uint32_t, uint32_t) noexcept;
template void seal(Description&, uint32_t, uint32_t) noexcept;
template void seal(PoseState&, uint32_t, uint32_t) noexcept;
template void seal(PoseCommand&, uint32_t, uint32_t) noexcept;
template std::optional<JointState> openWhole(std::span<const std::byte>) noexcept;
template std::optional<PoseState> openWhole(std::span<const std::byte>) noexcept;
template std::optional<JointState> open(std::span<const std::byte>) noexcept;
template std::optional<JointCommand> open(std::span<const std::byte>) noexcept;
template std::optional<DescribeRequest> open(std::span<const std::byte>) noexcept;
template std::optional<Describe> open(std::span<const std::byte>) noexcept;
template std::optional<Description> open(std::span<const std::byte>) noexcept;
template std::optional<PoseState> open(std::span<const std::byte>) noexcept;
template std::optional<PoseCommand> open(std::span<const std::byte>) noexcept;

}  // namespace bonemill::wire
