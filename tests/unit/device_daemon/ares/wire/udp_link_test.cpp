#include <gtest/gtest.h>

#include "common/base/user_error.h"
#include "common/rt/clock.h"
#include "device_daemon/ares/wire/controller_session.h"
#include "device_daemon/ares/wire/host_session.h"
#include "tests/unit/device_daemon/ares/wire/wire_test_tools.h"

namespace bonemill::wire {
namespace {

constexpr int64_t kSoonNs = 10'000'000'000;  // ends a test that hangs

TEST(UdpSocket, CarriesDatagramsWithTheirSource) {
    UdpSocket a, b;
    EXPECT_EQ(a.local().address, kLoopback);
    const std::byte text[3] = {std::byte{1}, std::byte{2}, std::byte{3}};
    ASSERT_TRUE(a.send(text, b.local()));
    ASSERT_TRUE(b.waitUntil(monotonicNowNs() + kSoonNs));
    std::byte buffer[2];
    Endpoint source;
    EXPECT_EQ(b.receive(buffer, source).size(), 2u) << "cut to the buffer";
    EXPECT_EQ(source, a.local());
    EXPECT_TRUE(b.receive(buffer, source).empty());
    EXPECT_FALSE(b.waitUntil(monotonicNowNs() + 1));
    EXPECT_FALSE(b.waitUntil(0));
}

TEST(UdpSocket, SaysWhatIsWrongWithAnAddress) {
    const UdpSocket taken;
    EXPECT_THROW(UdpSocket{taken.local()}, UserError);
    EXPECT_THROW(UdpSocket{endpointOf("203.0.113.7", 0)}, UserError);
    EXPECT_THROW(endpointOf("localhost", 1), UserError);
    EXPECT_EQ(textOf(endpointOf("192.168.1.20", 4040)), "192.168.1.20:4040");
}

TEST(UdpSocket, AdmitsOneAndAllAgain) {
    UdpSocket socket, friendly, stranger;
    const std::byte text[1] = {};
    std::byte buffer[1];
    Endpoint source;
    const auto heard = [&](UdpSocket& sender) {
        return sender.send(text, socket.local()) && !socket.receive(buffer, source).empty();
    };
    EXPECT_TRUE(heard(stranger));
    socket.admitOnly(friendly.local());
    EXPECT_FALSE(heard(stranger));
    EXPECT_TRUE(heard(friendly));
    socket.admitOnly(Endpoint{0x7f000002, friendly.local().port});
    EXPECT_FALSE(heard(friendly));
    socket.admitOnly(std::nullopt);
    EXPECT_TRUE(heard(stranger));
}

class FloodedLinks : public testing::Test {
  protected:
    void connect() {
        const int64_t end_ns = monotonicNowNs() + kSoonNs;
        while (!host.session().isDescribed() && monotonicNowNs() < end_ns) {
            host.poll(monotonicNowNs());
            controller.poll(monotonicNowNs());
        }
        ASSERT_TRUE(host.session().isDescribed());
    }
    static void floodByAStranger(const Endpoint& target) {
        UdpSocket stranger;
        const std::byte tiny[1] = {};  // large ones leave room for a packet
        for (int i = 0; i < 2000; ++i) stranger.send(tiny, target);
    }

    ControllerLink<JointPackets> controller{test::aresDescription(), {kLoopback, 0}};
    HostLink<JointPackets> host{{.controller = controller.local(), .seed = randomSeed()}, {kLoopback, 0}};
};

// It would fill the queue, the watchdog would trip, and the stranger could take the host's place.
TEST_F(FloodedLinks, AStrangersFloodDoesNotKeepTheHostOut) {
    connect();
    floodByAStranger(controller.local());
    JointState state{};
    controller.send(state, monotonicNowNs());
    host.poll(monotonicNowNs());
    JointCommand command{};
    ASSERT_TRUE(host.send(command, monotonicNowNs()));
    EXPECT_TRUE(controller.poll(monotonicNowNs()));
    EXPECT_EQ(controller.session().statistics().rejected, 0u) << "the kernel has dropped them";
}

// It would fill the queue, and the device would be lost.
TEST_F(FloodedLinks, AStrangersFloodDoesNotKeepTheControllersStatesOut) {
    connect();
    floodByAStranger(host.local());
    JointState state{};
    controller.send(state, monotonicNowNs());
    EXPECT_TRUE(host.poll(monotonicNowNs()));
    EXPECT_EQ(host.session().statistics().rejected, 0u) << "the kernel has dropped them";
}

TEST(UdpLinks, AControllerOfOneHostIsNobodyElses) {
    UdpSocket own;
    const Endpoint only = own.local();
    ControllerLink<JointPackets> controller(test::aresDescription(), {kLoopback, 0}, hereAt(only.port));
    HostLink<JointPackets> stranger({.controller = controller.local(), .seed = 1}, {kLoopback, 0});
    HostLink<JointPackets> host({.controller = controller.local(), .seed = 2}, std::move(own));
    stranger.poll(monotonicNowNs());
    controller.poll(monotonicNowNs());
    EXPECT_FALSE(controller.session().hasHost());
    host.poll(monotonicNowNs());
    controller.poll(monotonicNowNs());
    EXPECT_TRUE(controller.session().hasHost());
    EXPECT_EQ(controller.session().host(), only);
    controller.session().step(0, true, monotonicNowNs() + 2 * kForgetHostAfterNs);
    stranger.poll(monotonicNowNs() + kAskEveryNs);
    controller.poll(monotonicNowNs());
    EXPECT_FALSE(controller.session().hasHost()) << "not even after the host has gone";
}

TEST(UdpLinks, HostAndControllerFindEachOtherAndForceFlows) {
    Describe description = test::aresDescription();
    description.watchdog_us = kLongestWatchdogUs;
    ControllerLink<JointPackets> controller(description, {kLoopback, 0});
    HostLink<JointPackets> host({.controller = controller.local(), .seed = randomSeed()}, {kLoopback, 0});

    const int64_t end_ns = monotonicNowNs() + kSoonNs;
    const JointCommand* in_force = nullptr;
    while (!in_force && monotonicNowNs() < end_ns) {
        host.poll(monotonicNowNs());
        JointCommand command{};
        command.mode = kModeTorque;
        command.force[2] = 3;
        command.controlword =
            controlwordTowards(host.session().isTrusted(), driveStateOf(host.session().state().statusword));
        host.send(command, monotonicNowNs());
        controller.waitForCommand(monotonicNowNs() + kNsPerMillisecond);
        controller.session().step(0, true, monotonicNowNs());
        in_force = controller.session().commandInForce(monotonicNowNs());
        JointState state{};
        state.q[0] = 0.05;
        controller.send(state, monotonicNowNs());
    }
    ASSERT_TRUE(in_force);
    EXPECT_EQ(in_force->force[2], 3);
    EXPECT_EQ(host.session().state().q[0], 0.05);
}

}  // namespace
}  // namespace bonemill::wire
