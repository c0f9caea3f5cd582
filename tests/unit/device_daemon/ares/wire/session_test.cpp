#include <gtest/gtest.h>

#include "tests/unit/device_daemon/ares/wire/wire_test_tools.h"

namespace bonemill::wire {
namespace {

using test::Bytes;
using test::changed;
using test::kPeriodNs;
using test::Pair;

std::vector<Bytes> nothing(const Bytes&) {
    return {};
}
std::vector<Bytes> twice(const Bytes& bytes) {
    return {bytes, bytes};
}

TEST(Sessions, AreTrustedAfterTenGoodPacketsInBothDirections) {
    Pair pair;
    int periods = 0;
    for (; !pair.host.isTrusted() && periods < 100; ++periods) pair.period();
    EXPECT_GE(periods, 10);
    EXPECT_LE(periods, 14);
    pair.run(5);
    EXPECT_TRUE(pair.isEnabled());
    EXPECT_TRUE(pair.hasForce());
    EXPECT_STREQ(pair.host.description().name, "test ARES");
    EXPECT_EQ(pair.host.statistics().lost + pair.controller.statistics().lost, 0u);
}

TEST(Sessions, AreNotTrustedWhileTheControllerHearsNothing) {
    Pair pair;
    pair.on_command = nothing;
    pair.run(50);
    EXPECT_FALSE(pair.host.isTrusted());
    EXPECT_FALSE(pair.isEnabled());
}

TEST(Sessions, AControllerRefusesToEnableForAHostThatHearsNothing) {
    Pair pair;
    pair.on_state = nothing;
    pair.period();
    JointCommand command{};
    command.mode = kModeTorque;
    for (int i = 0; i < 50; ++i) {  // a host that enables blindly
        command.controlword = controlwordTowards(true, pair.controller.drive().state());
        if (pair.host.seal(command, pair.now_ns)) pair.deliverToController(test::copyOf(command));
        pair.period();
    }
    EXPECT_FALSE(pair.isEnabled());
}

TEST(Sessions, ALossBreaksTheRow) {
    Pair pair;
    int n = 0;
    pair.on_state = [&](const Bytes& b) {
        return ++n % 8 == 0 ? std::vector<Bytes>{} : std::vector<Bytes>{b};
    };
    pair.run(60);
    EXPECT_FALSE(pair.host.isTrusted());
    EXPECT_GT(pair.host.statistics().lost, 5u);
}

TEST(Sessions, TakeDuplicatesOnceAndNothingOld) {
    Pair pair;
    pair.on_state = twice;
    pair.on_command = twice;
    pair.run(30);
    EXPECT_TRUE(pair.hasForce());
    EXPECT_EQ(pair.host.statistics().old, pair.host.statistics().accepted);
    EXPECT_EQ(pair.controller.statistics().old, pair.controller.statistics().accepted);
    EXPECT_EQ(pair.host.statistics().lost, 0u);
}

TEST(Sessions, IgnoreWhatOthersHaveOvertaken) {
    Pair pair;
    pair.run(20);
    Bytes held;
    int n = 0;
    pair.on_command = [&](const Bytes& bytes) -> std::vector<Bytes> {
        if (++n % 2 == 1) {
            held = bytes;
            return {};
        }
        return {bytes, held};  // in the wrong order
    };
    pair.run(20);
    EXPECT_EQ(pair.controller.statistics().old, 10u);
    EXPECT_EQ(pair.controller.statistics().lost, 10u);
    EXPECT_TRUE(pair.hasForce());
}

TEST(Sessions, IgnoreStrangers) {
    Pair pair;
    pair.run(20);
    const uint64_t accepted = pair.controller.statistics().accepted;
    Bytes genuine;
    pair.on_command = [&](const Bytes& bytes) {
        genuine = bytes;
        return std::vector<Bytes>{};
    };
    pair.period();
    pair.deliverToController(genuine, {kLoopback, 5555});
    pair.deliverToController(genuine, {0x7f000002, test::kHostPlace.port});
    EXPECT_EQ(pair.controller.statistics().accepted, accepted);
    EXPECT_EQ(pair.controller.statistics().rejected, 2u);
    pair.deliverToController(genuine);
    EXPECT_EQ(pair.controller.statistics().accepted, accepted + 1);
    pair.deliverToController(genuine);
    EXPECT_EQ(pair.controller.statistics().accepted, accepted + 1) << "a replay";
}

TEST(Sessions, IgnorePacketsOfOtherSessions) {
    Pair pair;
    pair.run(20);
    const auto ofAnother = [](const auto& packet, const Bytes& bytes) {
        auto other = packet;
        std::memcpy(&other, bytes.data(), bytes.size());
        seal(other, other.header.session + 1, other.header.sequence);
        return std::vector<Bytes>{test::copyOf(other)};
    };
    const uint64_t states = pair.host.statistics().accepted, commands = pair.controller.statistics().accepted;
    pair.on_state = [&](const Bytes& bytes) { return ofAnother(JointState{}, bytes); };
    pair.on_command = [&](const Bytes& bytes) { return ofAnother(JointCommand{}, bytes); };
    pair.run(3);
    EXPECT_EQ(pair.host.statistics().accepted, states);
    EXPECT_EQ(pair.controller.statistics().accepted, commands);
    EXPECT_EQ(pair.host.statistics().rejected, 3u);
    EXPECT_EQ(pair.controller.statistics().rejected, 3u);
}

TEST(Sessions, IgnoreASecondHostWhileTheFirstLives) {
    Pair pair;
    pair.run(20);
    HostSession<JointPackets> second({.controller = test::kControllerPlace, .seed = 8});
    const Endpoint place{kLoopback, 5555};
    const Bytes request = test::copyOf(*second.requestDue(pair.now_ns));
    EXPECT_EQ(pair.controller.take(request, place, pair.now_ns), Taken::kNothing);
    pair.run(5);
    EXPECT_TRUE(pair.hasForce());
    pair.host_sends = false;
    const int64_t heard_ns = pair.now_ns;
    pair.run(10);
    EXPECT_EQ(pair.controller.drive().firstFault(), kFaultWatchdog);
    pair.controller.step(0, true, heard_ns + kForgetHostAfterNs);
    EXPECT_EQ(pair.controller.take(request, place, heard_ns + kForgetHostAfterNs), Taken::kNothing)
        << "the first may ask again";
    pair.controller.step(0, true, heard_ns + kForgetHostAfterNs + 1);
    EXPECT_EQ(pair.controller.take(request, place, heard_ns + kForgetHostAfterNs + 1), Taken::kRequest);
    EXPECT_EQ(pair.controller.host(), place);
}

// It could otherwise hide that it was silent while its motors were on.
TEST(Sessions, AHostThatAsksAnewHasToWaitForTheWatchdogsFault) {
    Pair pair;
    pair.run(20);
    HostSession<JointPackets> anew({.controller = test::kControllerPlace, .seed = 8});
    const int64_t later_ns = pair.now_ns + 6'000'000;
    const Bytes request = test::copyOf(*anew.requestDue(later_ns));
    EXPECT_EQ(pair.controller.take(request, test::kHostPlace, later_ns), Taken::kNothing);
    pair.controller.step(0, true, later_ns);
    EXPECT_EQ(pair.controller.take(request, test::kHostPlace, later_ns), Taken::kRequest);
    EXPECT_EQ(pair.controller.drive().firstFault(), kFaultWatchdog);
}

TEST(Sessions, IgnorePacketsThatReflectWhatWasNeverSent) {
    Pair pair;
    pair.run(20);
    const uint64_t accepted = pair.controller.statistics().accepted;
    pair.on_command = [&](const Bytes& bytes) {
        return std::vector<Bytes>{
            changed<JointCommand>(bytes, [](auto& c) { c.reflected_sequence += 1000; })};
    };
    pair.run(3);
    EXPECT_EQ(pair.controller.statistics().rejected, 3u);
    EXPECT_EQ(pair.controller.statistics().accepted, accepted);
}

TEST(Sessions, SurviveTheWrappingOfSequenceNumbers) {
    PacketFlow flow;
    flow.begin(0xfffffff0, 0xfffffff5, kPeriodNs, 0);
    for (uint32_t i = 1; i < 40; ++i) {
        EXPECT_TRUE(flow.accept(0xfffffff0 + i, 0xfffffff5 + i, 0xfffffff5 + i, i * kPeriodNs, i * kPeriodNs))
            << i;
    }
    EXPECT_TRUE(flow.isTrusted());
    EXPECT_EQ(flow.statistics().lost, 0u);
    EXPECT_EQ(flow.newestSequence(), 23u);
}

TEST(Sessions, SilenceOfTheHostTripsTheWatchdogUntilItIsReset) {
    Pair pair;
    pair.run(20);
    pair.host_sends = false;
    pair.run(5);
    EXPECT_TRUE(pair.isEnabled());
    pair.period();
    EXPECT_FALSE(pair.hasForce());
    EXPECT_EQ(pair.controller.drive().firstFault(), kFaultWatchdog);
    EXPECT_EQ(pair.controller.watchdogTrips(), 1u);
    pair.host_sends = true;
    pair.run(20);
    EXPECT_FALSE(pair.hasForce()) << "it stays latched";
    EXPECT_EQ(pair.host.state().first_fault, kFaultWatchdog);
    EXPECT_EQ(pair.host.state().active_faults, 0u);
    pair.resets = true;
    pair.period();
    pair.resets = false;
    pair.run(5);
    EXPECT_TRUE(pair.hasForce());
    EXPECT_EQ(pair.controller.watchdogTrips(), 1u);
}

// The force ends with the watchdog even between two periods of the controller.
TEST(Sessions, ForceEndsWithTheWatchdogAndWithTheCommandsOwnTime) {
    Pair pair;
    pair.run(20);
    EXPECT_NE(pair.controller.commandInForce(pair.now_ns + 5'000'000), nullptr);
    EXPECT_EQ(pair.controller.commandInForce(pair.now_ns + 5'000'001), nullptr);
    pair.on_command = [](const Bytes& bytes) {
        return std::vector<Bytes>{changed<JointCommand>(bytes, [](auto& c) { c.valid_for_us = 2000; })};
    };
    pair.period();
    EXPECT_NE(pair.controller.commandInForce(pair.now_ns + 2'000'000), nullptr);
    EXPECT_EQ(pair.controller.commandInForce(pair.now_ns + 2'000'001), nullptr);
}

TEST(Sessions, SilenceOfAHostThatHasSwitchedOffIsNoFault) {
    Pair pair;
    pair.run(20);
    pair.is_wanted = false;
    pair.run(3);
    pair.host_sends = false;
    pair.run(20);
    EXPECT_EQ(pair.controller.drive().state(), DriveState::kSwitchOnDisabled);
    EXPECT_EQ(pair.controller.watchdogTrips(), 0u);
}

TEST(Sessions, AHostThatLosesItsControllerAsksUntilItIsBack) {
    Pair pair;
    pair.run(20);
    const uint32_t session = pair.host.state().header.session;
    const auto straight = pair.on_state;
    pair.on_state = nothing;
    pair.run(5);
    EXPECT_FALSE(pair.host.isLost(pair.now_ns));
    pair.run(2);
    EXPECT_TRUE(pair.host.isLost(pair.now_ns));
    EXPECT_FALSE(pair.host.isTrusted());
    pair.run(500);
    pair.on_state = straight;
    pair.resets = true;
    pair.run(110);
    pair.resets = false;
    pair.run(20);
    EXPECT_TRUE(pair.host.isTrusted());
    EXPECT_GT(pair.host.descriptionCount(), 1u);
    EXPECT_NE(pair.host.state().header.session, session);
    EXPECT_TRUE(pair.hasForce());
}

TEST(Sessions, LatePacketsFillTheBucketAndPunctualOnesEmptyIt) {
    PacketFlow flow;
    flow.begin(0, 0, kPeriodNs, 0);
    int64_t now_ns = 0;
    uint32_t n = 0;
    const auto come = [&](int packets, int64_t after_ns) {
        for (int i = 0; i < packets; ++i) {
            ++n;
            flow.accept(n, n, n, n * kPeriodNs, now_ns += after_ns);
        }
    };
    come(1000, kPeriodNs * 14 / 10);
    EXPECT_EQ(flow.statistics().late, 0u);
    for (int i = 0; i < 200; ++i) {  // every sixth one is late
        come(1, 2 * kPeriodNs);
        come(5, kPeriodNs / 2);
    }
    EXPECT_FALSE(flow.tooManyLate());
    come(24, 2 * kPeriodNs);
    EXPECT_FALSE(flow.tooManyLate());
    come(1, 2 * kPeriodNs);
    EXPECT_TRUE(flow.tooManyLate());
    come(99, kPeriodNs);
    EXPECT_TRUE(flow.tooManyLate());
    come(1, kPeriodNs);
    EXPECT_FALSE(flow.tooManyLate());
}

// A host whose PC is busy sends in bursts, and its stamps say so: no other wire would help it.
TEST(Sessions, WhatWasSentLateIsNotTheWiresFault) {
    PacketFlow flow;
    flow.begin(0, 0, kPeriodNs, 0);
    int64_t now_ns = 0;
    for (uint32_t n = 1; n <= 200; ++n) {
        now_ns += 3 * kPeriodNs;
        flow.accept(n, n, n, now_ns + 77, now_ns);
    }
    EXPECT_FALSE(flow.tooManyLate());
    EXPECT_LE(flow.statistics().late, 1u) << "of the first one's sender nothing is known";
    EXPECT_EQ(flow.statistics().paused, 199u);
}

// A host of before asks with no bit set, and a controller of before answers with a Describe whatever is
// asked.
TEST(Sessions, WhatIsKnownOfTheHandleIsToldToWhoUnderstands) {
    Describe describe{};
    describe.watchdog_us = kDefaultWatchdogUs;
    describe.rate_hz = 1000;
    Handle handle{};
    handle.mass = 0.13, handle.delay = 2e-3;
    ControllerSession<PosePackets> controller(describe, handle);
    HostSession<PosePackets> host({.controller = test::kControllerPlace, .seed = 3});
    const DescribeRequest asked = *host.requestDue(1);
    controller.take(bytesOf(asked), test::kHostPlace, 1);
    const auto said = controller.sealDescription();
    ASSERT_TRUE(open<Description>(said));
    host.take(said, test::kControllerPlace, 1);
    EXPECT_TRUE(host.isDescribed());
    EXPECT_EQ(host.handle().mass, 0.13);
    EXPECT_EQ(host.handle().delay, 2e-3);

    HostSession<PosePackets> other({.controller = test::kControllerPlace, .seed = 4});
    DescribeRequest old = *other.requestDue(1);
    old.understands = 0;
    seal(old, old.header.session, old.header.sequence);
    ControllerSession<PosePackets> anew(describe, handle);
    anew.take(bytesOf(old), test::kHostPlace, 1);
    const auto short_one = anew.sealDescription();
    ASSERT_TRUE(open<Describe>(short_one));
    other.take(short_one, test::kControllerPlace, 1);
    EXPECT_TRUE(other.isDescribed());
    EXPECT_EQ(other.handle().mass, 0);
}

TEST(Sessions, LateCommandsAreAFault) {
    Pair pair;
    pair.run(20);
    int n = 0;
    pair.on_command = [&](const Bytes& bytes) {
        return ++n % 3 == 0 ? std::vector<Bytes>{bytes} : std::vector<Bytes>{};
    };
    pair.run(80);
    EXPECT_FALSE(pair.hasForce());
    EXPECT_EQ(pair.controller.drive().firstFault(), kFaultLatePackets);
}

TEST(Sessions, TheHostChoosesTheWatchdogWithinBounds) {
    const std::pair<uint32_t, uint32_t> cases[] = {{0, 5000}, {12000, 12000}, {1, 2000}, {1000000, 30000}};
    for (const auto& [wanted, expected] : cases) {
        Pair pair;
        pair.host = HostSession<JointPackets>(
            {.controller = test::kControllerPlace, .watchdog_us = wanted, .seed = 3});
        pair.run(5);
        EXPECT_EQ(pair.host.description().watchdog_us, expected);
    }
}

TEST(Sessions, RefuseDescriptionsThatMakeNoSense) {
    const std::pair<const char*, std::function<void(Describe&)>> damages[] = {
        {"watchdog_us", [](Describe& d) { d.watchdog_us = 1999; }},
        {"watchdog_us", [](Describe& d) { d.watchdog_us = 30001; }},
        {"rate_hz", [](Describe& d) { d.rate_hz = 0; }},
        {"rate_hz", [](Describe& d) { d.rate_hz = 399; }},
        {"kind", [](Describe& d) { d.kind = 99; }},
        {"max_force", [](Describe& d) { d.max_force = -1; }},
        {"stroke", [](Describe& d) { d.stroke = 0; }},
        {"max_actuator_force", [](Describe& d) { d.max_actuator_force = 0; }},
    };
    for (const auto& [figure, damage] : damages) {
        HostSession<JointPackets> host({.controller = test::kControllerPlace, .seed = 3});
        const DescribeRequest* request = host.requestDue(1);
        Describe description = test::aresDescription();
        damage(description);
        seal(description, request->header.session, 1);
        host.take(test::copyOf(description), test::kControllerPlace, 2);
        EXPECT_FALSE(host.isDescribed());
        EXPECT_EQ(host.statistics().rejected, 1u);
        EXPECT_STREQ(host.refusedFigure(), figure);
    }
}

TEST(Sessions, APoseHostDoesNotTakeJointsForAPose) {
    HostSession<PosePackets> host({.controller = test::kControllerPlace, .seed = 3});
    Describe description = test::aresDescription();
    seal(description, host.requestDue(1)->header.session, 1);
    host.take(test::copyOf(description), test::kControllerPlace, 2);
    EXPECT_FALSE(host.isDescribed());
    EXPECT_STREQ(host.refusedFigure(), "max_actuator_force");
    description.max_actuator_force = 0;
    seal(description, description.header.session, 2);
    host.take(test::copyOf(description), test::kControllerPlace, 3);
    EXPECT_TRUE(host.isDescribed());
    EXPECT_EQ(host.refusedFigure(), nullptr);
}

}  // namespace
}  // namespace bonemill::wire
