// Uses each profile with real programs on several PCs; all viewers end with the server's model.
#include <arpa/inet.h>
#include <sys/socket.h>

#include <cerrno>
#include <sstream>

#include "tests/integration/network/network_session.h"
#include "tests/support/places.h"

namespace bonemill {
namespace {

using test::Host;
using test::joined;
using test::Process;
using test::waitFor;
using test::Words;

class Profiles : public test::NetworkSession {
  protected:
    // These viewers watch the milling from its start, a late one comes when all is done; all show what the
    // server published last.
    void expectAllConverge(const Words& server, const std::vector<std::pair<const Host*, Words>>& viewers) {
        startServer(server);
        std::vector<std::unique_ptr<Process>> probes;
        for (const auto& [host, network] : viewers) probes.push_back(probe(*host, network));
        for (const auto& probe : probes)
            ASSERT_TRUE(waitFor([&] { return isWhole(*probe); })) << probe->errSoFar();
        const std::string first = newest(*probes.front())["digest"];
        const uint64_t sent = haptics_pc_->traffic().sent_bytes;
        const uint64_t received = viewers.back().first->traffic().received_bytes;
        startMilling(2);
        waitForDevice();
        sent_bytes_ = haptics_pc_->traffic().sent_bytes - sent;
        received_bytes_ = viewers.back().first->traffic().received_bytes - received;
        const auto late = picture(*viewers.back().first, viewers.back().second);
        std::vector<const Process*> all;
        for (const auto& probe : probes) all.push_back(probe.get());
        ASSERT_TRUE(waitFor([&] { return agree(all); }));
        const auto report = stopServer();
        EXPECT_NE(report["published_digest"], first) << "nothing was milled";
        EXPECT_EQ(late["node_digest"], report["published_digest"]);
        EXPECT_EQ(late["complete"], true);
        for (const auto& probe : probes) EXPECT_EQ(newest(*probe)["digest"], report["published_digest"]);
    }
    // They count while the bone was milled: by the haptics PC, and by the last viewer's.
    uint64_t sent_bytes_ = 0, received_bytes_ = 0;
};

TEST_F(Profiles, OnePcServesItsOwnViewersAndNobodyElse) {
    const Host other = network_->addHost();
    const auto stranger = probe(other, {});
    const Words lab{"--profile", "lab", "--interface", "eth0"};
    const auto lab_stranger = probe(other, lab);
    expectAllConverge({}, {{haptics_pc_.get(), {}}, {haptics_pc_.get(), {"--profile", "one-pc"}}});
    EXPECT_EQ(newest(*stranger)["changes"], 0);
    EXPECT_EQ(newest(*lab_stranger)["changes"], 0);
}

// A port that nobody listens to for this sender is answered as closed.
TEST_F(Profiles, OnOnePcNoPortIsOpenToOthers) {
    const Host other = network_->addHost();
    // The kernel says so six times, and then once per second.
    const auto unlimited =
        haptics_pc_->start({"/bin/sh", "-c", "echo 0 > /proc/sys/net/ipv4/icmp_ratelimit"})->wait();
    ASSERT_EQ(unlimited.exit_code, 0) << unlimited.err;
    startServer({});
    const auto own = probe(*haptics_pc_, {});
    ASSERT_TRUE(waitFor([&] { return isWhole(*own); })) << own->errSoFar();
    std::istringstream table(test::readFile("/proc/" + std::to_string(own->pid()) + "/net/udp"));
    std::string line, number, local;
    std::getline(table, line);
    int ports = 0;
    const test::Descriptor stranger = other.udpSocket(4000);
    for (; std::getline(table, line); ++ports) {
        std::istringstream(line) >> number >> local;
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(uint16_t(std::stoi(local.substr(local.find(':') + 1), nullptr, 16)));
        inet_pton(AF_INET, haptics_pc_->address().c_str(), &address.sin_addr);
        ASSERT_EQ(connect(stranger.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
        char byte = 0;
        ASSERT_EQ(send(stranger.number(), &byte, 1, 0), 1);
        ASSERT_EQ(recv(stranger.number(), &byte, 1, 0), -1);
        EXPECT_EQ(errno, ECONNREFUSED) << "open: " << line;
    }
    EXPECT_GE(ports, 4);
}

TEST_F(Profiles, LabServesItsOwnAndOtherPcs) {
    const Host first = network_->addHost(), second = network_->addHost();
    const Words lab{"--profile", "lab", "--interface", "eth0"};
    expectAllConverge(lab, {{haptics_pc_.get(), lab},
                            {&first, lab},
                            {&second, {"--profile", "lab", "--interface", second.address()}}});
}

TEST_F(Profiles, LabFindsPeersWithoutMulticast) {
    const Host first = network_->addHost(), second = network_->addHost();
    const Words lab{"--profile", "lab", "--interface", "eth0"};
    const Words by_peer = joined(lab, {"--peer", haptics_pc_->address()});
    expectAllConverge(lab, {{haptics_pc_.get(), lab}, {&first, by_peer}, {&second, by_peer}});
}

TEST_F(Profiles, ClassroomServesManyPcs) {
    const Words classroom{"--profile", "classroom", "--interface", "eth0"};
    std::vector<Host> pupils;
    std::vector<std::pair<const Host*, Words>> viewers{{haptics_pc_.get(), classroom}};
    for (int i = 0; i < 6; ++i) pupils.push_back(network_->addHost());
    for (const Host& pupil : pupils) viewers.push_back({&pupil, classroom});
    expectAllConverge(classroom, viewers);
    EXPECT_GT(received_bytes_, 100'000u);
    EXPECT_LT(sent_bytes_, 2 * received_bytes_) << "not once for all";
}

TEST_F(Profiles, AWrongInterfaceEndsEveryProgramWithOneMessage) {
    for (const char* program : {"haptic_server", "render_client"}) {
        const Words command =
            program == std::string("haptic_server")
                ? Words{program, "--scene", test::sourceDir() + "/deploy/scenes/tooth_wall.textproto"}
                : Words{program};
        const auto wrong =
            haptics_pc_->start(joined(command, {"--profile", "lab", "--interface", "eth7"}))->wait();
        EXPECT_EQ(wrong.exit_code, 2);
        EXPECT_EQ(wrong.err,
                  "error: --interface eth7: this PC has no such interface; it has: eth0 (10.77.0.1)\n");
    }
}

}  // namespace
}  // namespace bonemill
