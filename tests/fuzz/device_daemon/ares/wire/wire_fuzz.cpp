// Ten million damaged packets come to a host and a controller between their genuine ones. Half of them have a
// right CRC, so that what follows it is tried, too. Nothing that is not well-formed may be believed, and no
// force may flow but that of the last command that could be.
#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <cmath>
#include <cstring>
#include <random>

#include "device_daemon/ares/wire/controller_session.h"
#include "device_daemon/ares/wire/host_session.h"

namespace bonemill::wire {
namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr int kPackets = 300'000;
#else
constexpr int kPackets = 10'000'000;
#endif
constexpr int kPacketsPerPeriod = 8;
constexpr int64_t kPeriodNs = 1'000'000;
constexpr Endpoint kControllerPlace{kLoopback, 4040}, kHostPlace{kLoopback, 4041}, kStranger{kLoopback, 4042};

// NaN and -infinity, and their upper halves in double precision.
constexpr uint32_t kNoNumbers[] = {0x7fc00000, 0xff800000, 0x7ff80000, 0xfff00000};

struct Datagram {
    std::array<std::byte, kMaxPacket> bytes{};
    size_t size = 0;
    std::span<const std::byte> content() const { return std::span(bytes).first(size); }
};

template <class Packet>
Datagram datagramOf(const Packet& packet) {
    Datagram datagram;
    datagram.size = sizeof(packet);
    std::memcpy(datagram.bytes.data(), &packet, sizeof(packet));
    return datagram;
}

Datagram datagramOf(std::span<const std::byte> bytes) {
    Datagram datagram;
    datagram.size = bytes.size();
    std::copy(bytes.begin(), bytes.end(), datagram.bytes.begin());
    return datagram;
}

// The oracle: it reads bytes at the offsets that docs/reference/ares_link.md names, and knows nothing of the
// codec.
template <class T>
T at(std::span<const std::byte> bytes, size_t offset) {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof(value));
    return value;
}

uint32_t crcOf(std::span<const std::byte> bytes) {
    return uint32_t(crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), uInt(bytes.size())));
}

bool isWellFormed(std::span<const std::byte> bytes, size_t size, uint8_t type) {
    return bytes.size() == size && at<uint32_t>(bytes, 0) == 0x4c4d4342 && at<uint8_t>(bytes, 4) == 1 &&
           at<uint8_t>(bytes, 5) == type && at<uint16_t>(bytes, 6) == size &&
           at<uint32_t>(bytes, size - 4) == crcOf(bytes.first(size - 4));
}

bool hasFiniteForces(std::span<const std::byte> command) {
    for (size_t i = 0; i < 6; ++i) {
        if (!std::isfinite(at<float>(command, 48 + 4 * i))) return false;
    }
    return true;
}

class Damage {
  public:
    size_t below(size_t n) { return random_() % n; }

    // A few bits or bytes are changed, sometimes to numbers that are none, or the length is.
    Datagram of(const Datagram& valid) {
        Datagram d = valid;
        if (below(50) == 0) return noise();
        for (size_t changes = 1 + below(3); changes > 0; --changes) {
            const size_t place = below(d.size);
            switch (below(5)) {
                case 0:
                    d.bytes[place] ^= std::byte(1u << below(8));
                    break;
                case 1:
                    d.bytes[place] = std::byte(random_());
                    break;
                case 2:
                    std::memcpy(&d.bytes[place / 4 * 4], &kNoNumbers[below(4)], 4);
                    break;
                case 3:
                    if (below(8) == 0) d.size = 1 + below(kMaxPacket);
                    break;
                default:  // the numbers of the session: a few steps on
                    d.bytes[below(2) ? 12 : 16] ^= std::byte(below(16));
                    break;
            }
        }
        if (below(2) == 0 && d.size > 4) {
            const uint32_t crc = crcOf(d.content().first(d.size - 4));
            std::memcpy(&d.bytes[d.size - 4], &crc, 4);
        }
        return d;
    }

  private:
    Datagram noise() {
        Datagram d;
        d.size = 1 + below(kMaxPacket);
        for (size_t i = 0; i < d.size; ++i) d.bytes[i] = std::byte(random_());
        return d;
    }
    std::minstd_rand random_{20121};
};

Describe description() {
    Describe d{};
    d.max_actuator_force = 50;
    d.stroke = 0.15;
    d.watchdog_us = kDefaultWatchdogUs;
    d.rate_hz = 1000;
    return d;
}

class Hostilities {
  public:
    void period() {
        now_ns_ += kPeriodNs;
        if (const DescribeRequest* request = host_.requestDue(now_ns_)) {
            request_ = datagramOf(*request);
            toController(request_, kHostPlace);
        }
        if (controller_.hasHost()) {
            JointState state{};
            state.q[0] = 0.05;
            controller_.seal(state, now_ns_);
            state_ = datagramOf(state);
            toHost(state_, kControllerPlace);
        }
        JointCommand command{};
        const DriveState drive = driveStateOf(host_.state().statusword);
        command.controlword = drive == DriveState::kFault && ++faulty_ % 2
                                  ? uint16_t(kControlFaultReset)
                                  : controlwordTowards(host_.isTrusted(), drive);
        command.mode = kModeTorque;
        for (float& f : command.force) f = 3;
        if (host_.seal(command, now_ns_)) {
            command_ = datagramOf(command);
            toController(command_, kHostPlace);
        }
        controller_.step(0, true, now_ns_);
        forceful_ += controller_.commandInForce(now_ns_) != nullptr;
        checkForce();
    }

    void attack() {
        const Endpoint other = damage_.below(10) == 0 ? kStranger : kHostPlace;
        switch (damage_.below(4)) {
            case 0:
                return toController(damage_.of(command_), other);
            case 1:
                return toController(damage_.of(request_), other);
            case 2:
                return toHost(damage_.of(state_), other == kStranger ? kStranger : kControllerPlace);
            default:
                return toHost(damage_.of(description_), other == kStranger ? kStranger : kControllerPlace);
        }
    }

    uint64_t forcefulPeriods() const { return forceful_; }
    bool hasForce() const { return controller_.commandInForce(now_ns_) != nullptr; }
    const ControllerSession<JointPackets>& controller() const { return controller_; }
    const HostSession<JointPackets>& host() const { return host_; }

  private:
    void toController(const Datagram& d, const Endpoint& from) {
        const Taken taken = controller_.take(d.content(), from, now_ns_);
        if (taken == Taken::kCommand) {
            ASSERT_TRUE(from == controller_.host() && isWellFormed(d.content(), 80, 2) &&
                        hasFiniteForces(d.content()));
            ASSERT_EQ(at<uint32_t>(d.content(), 8), controller_session_);
            valid_ = d;
            valid_ns_ = now_ns_;
        } else if (taken == Taken::kRequest) {
            ASSERT_TRUE(isWellFormed(d.content(), 40, 3));
            controller_session_ = at<uint32_t>(d.content(), 8);
            description_ = datagramOf(controller_.sealDescription());
            toHost(description_, kControllerPlace);
        }
        checkForce();
    }

    void toHost(const Datagram& d, const Endpoint& from) {
        const uint32_t descriptions = host_.descriptionCount();
        if (host_.take(d.content(), from, now_ns_)) {
            ASSERT_TRUE(from == kControllerPlace && isWellFormed(d.content(), 216, 1));
            ASSERT_EQ(at<uint32_t>(d.content(), 8), host_session_);
            for (size_t i = 0; i < 6; ++i) ASSERT_TRUE(std::isfinite(at<double>(d.content(), 48 + 8 * i)));
        }
        if (host_.descriptionCount() != descriptions) {
            ASSERT_TRUE(from == kControllerPlace &&
                        (isWellFormed(d.content(), 160, 4) || isWellFormed(d.content(), 232, 4)));
            ASSERT_EQ(at<uint32_t>(d.content(), 8), at<uint32_t>(request_.content(), 8));
            host_session_ = at<uint32_t>(d.content(), 8);
            ASSERT_GE(host_.description().watchdog_us, 2000u);
            ASSERT_LE(host_.description().watchdog_us, 30000u);
        }
    }

    // What the motors are told is what the last valid command says, and no older than the watchdog.
    void checkForce() {
        const JointCommand* command = controller_.commandInForce(now_ns_);
        if (!command) return;
        ASSERT_LE(now_ns_ - valid_ns_, kLongestWatchdogUs * int64_t(1000));
        ASSERT_EQ(std::memcmp(command->force, &valid_.bytes[48], sizeof(command->force)), 0);
        ASSERT_EQ(at<uint8_t>(valid_.content(), 34), 10) << "mode torque";
    }

    HostSession<JointPackets> host_{{.controller = kControllerPlace, .seed = 11}};
    ControllerSession<JointPackets> controller_{description()};
    Damage damage_;
    int64_t now_ns_ = 1'000'000'000;
    uint64_t forceful_ = 0;
    uint64_t faulty_ = 0;
    Datagram request_ = datagramOf(DescribeRequest{}), description_ = datagramOf(Describe{}),
             state_ = datagramOf(JointState{}), command_ = datagramOf(JointCommand{});
    Datagram valid_;
    int64_t valid_ns_ = 0;
    uint32_t controller_session_ = 0, host_session_ = 0;  // as each has agreed to them last
};

TEST(WireFuzz, NothingMalformedIsBelievedAndNoForceFlowsThatWasNotCommanded) {
    Hostilities hostilities;
    for (int i = 0; i < 100; ++i) hostilities.period();
    ASSERT_TRUE(hostilities.hasForce());
    for (int i = 0; i < kPackets && !HasFatalFailure(); ++i) {
        // Now and then there is peace, so that the two find each other again.
        const bool is_peace = i / 8000 % 4 == 3;
        if (!is_peace) hostilities.attack();
        if (i % kPacketsPerPeriod == 0) hostilities.period();
    }
    RecordProperty("forceful_periods", int(hostilities.forcefulPeriods()));
    EXPECT_GT(hostilities.forcefulPeriods(), uint64_t(kPackets / kPacketsPerPeriod / 10));
    EXPECT_GT(hostilities.controller().statistics().rejected, uint64_t(kPackets / 10));
    EXPECT_GT(hostilities.host().statistics().rejected, uint64_t(kPackets / 10));
    for (int i = 0; i < 2000 && !hostilities.hasForce(); ++i) hostilities.period();
    EXPECT_TRUE(hostilities.hasForce()) << "they find each other again";
}

struct PoseSide {
    HostSession<PosePackets> host{{.controller = kControllerPlace, .seed = 11}};
    ControllerSession<PosePackets> controller{[] {
        Describe d = description();
        d.max_actuator_force = 0;
        return d;
    }()};
    PoseSide() {
        controller.take(bytesOf(*host.requestDue(1)), kHostPlace, 1);
        host.take(controller.sealDescription(), kControllerPlace, 1);
    }
};

TEST(WireFuzz, PosesAreBelievedOnlyWhenTheyAreWellFormed) {
    constexpr int kPacketsPerSession = 500;  // one that is believed may carry its numbers far away
    Damage damage;
    uint64_t believed_states = 0, believed_commands = 0;
    for (int i = 0; i < kPackets / 20 / kPacketsPerSession && !HasFatalFailure(); ++i) {
        PoseSide side;
        for (int k = 2; k < kPacketsPerSession; ++k) {
            PoseState state{};
            PoseCommand command{};
            command.mode = kModeTorque;
            side.controller.seal(state, k);
            side.host.seal(command, k);
            const Datagram s = damage.of(datagramOf(state)), c = damage.of(datagramOf(command));
            if (side.host.take(s.content(), kControllerPlace, k)) {
                const PoseState& believed = side.host.state();
                ASSERT_TRUE(isWellFormed(s.content(), 168, 5));
                ASSERT_TRUE(std::isfinite(believed.p_DT[0]) && std::isfinite(believed.q_DT[3]));
                ASSERT_EQ(std::isnan(believed.v_DT[0]), std::isnan(believed.w_DT[2]));
            }
            if (side.controller.take(c.content(), kHostPlace, k) == Taken::kCommand) {
                ASSERT_TRUE(isWellFormed(c.content(), 80, 6) && hasFiniteForces(c.content()));
            }
            ASSERT_EQ(side.controller.commandInForce(k), nullptr) << "nobody has enabled it";
        }
        believed_states += side.host.statistics().accepted;
        believed_commands += side.controller.statistics().accepted;
    }
    EXPECT_GT(believed_states, uint64_t(kPackets / 20 / 100));
    EXPECT_GT(believed_commands, uint64_t(kPackets / 20 / 100));
}

}  // namespace
}  // namespace bonemill::wire
