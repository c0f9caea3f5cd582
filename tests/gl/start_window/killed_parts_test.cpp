// Whichever part of a session that the window has started is killed, and whenever: nothing of it stays,
// neither a process, nor memory, nor a port.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/sem.h>
#include <sys/shm.h>

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <random>
#include <sstream>
#include <thread>

#include "common/ipc/link_place.h"
#include "tests/gl/start_window/start_rig.h"

namespace bonemill {
namespace {

constexpr int kWidth = 800, kHeight = 600;
constexpr int kRounds = 5;                    // each part once, or BONEMILL_KILL_ROUNDS
constexpr int kLatest = 6000, kAfter = 2000;  // ms
const std::vector<std::string> kParts{"start_window", "bonemill", "haptic_server", "device_daemon",
                                      "render_client"};

int wantedRounds() {
    const char* const wanted = std::getenv("BONEMILL_KILL_ROUNDS");
    return wanted ? std::max(1, std::atoi(wanted)) : kRounds;
}

// The link's memory or semaphores lie there, and nobody lives on it. Another test may have the session by
// now.
bool isLinkLeft(uint32_t session) {
    const int id = shmget(linkKeyOf(session), 0, 0);
    shmid_ds status{};
    if (id < 0) return semget(linkKeyOf(session), 0, 0) >= 0;
    return shmctl(id, IPC_STAT, &status) == 0 && status.shm_nattch == 0;
}

// Of the ports that this test's domain has, as /proc/net/udp tells them: "  12: 0100007F:1CE8 ...".
std::vector<unsigned> takenPorts() {
    const unsigned first = 7400 + 250 * testDomain();
    std::vector<unsigned> ports;
    std::istringstream lines(test::readFile("/proc/net/udp"));
    for (std::string line; std::getline(lines, line);) {
        const size_t colon = line.find(':', line.find(':') + 1);
        if (colon == std::string::npos) continue;
        const auto port = unsigned(std::strtoul(line.substr(colon + 1, 4).c_str(), nullptr, 16));
        if (port >= first && port < first + 250) ports.push_back(port);
    }
    return ports;
}

class KilledParts : public testing::Test {
  protected:
    int pidOf(const std::string& part) {
        if (part == "start_window") return rig_.window().pid();
        const auto session = rig_.session();
        if (session) number_ = session->number;
        const auto found = session ? session->pids.find(part) : std::map<std::string, int>::const_iterator{};
        return session && found != session->pids.end() ? found->second : 0;
    }
    void pause(int most_ms) {
        std::this_thread::sleep_for(
            std::chrono::milliseconds(std::uniform_int_distribution<>(0, most_ms)(dice_)));
    }
    void startSession(bool is_scripted) {
        rig_.open();
        rig_.await("a session", [&] {
            if (is_scripted) rig_.click("Scripted: it shows how");
            rig_.click("tooth_corridor");
            return test::waitFor([&] { return rig_.session().has_value(); }, std::chrono::seconds(2));
        });
    }
    void expectNothingLeft() {
        EXPECT_TRUE(test::waitFor([&] { return rig_.processes().empty(); })) << test::run({"ps", "-ef"}).out;
        EXPECT_TRUE(test::waitFor([&] { return !isLinkLeft(number_); })) << "session " << number_;
        EXPECT_TRUE(test::waitFor([] { return takenPorts().empty(); })) << takenPorts().size();
        EXPECT_EQ(test::run(rig_.words({"list"})).out.rfind("No session runs.", 0), 0u);
    }

    test::StartRig rig_{kWidth, kHeight};
    std::minstd_rand dice_{1};
    uint32_t number_ = 0;
};

TEST_F(KilledParts, LeaveNothingBehind) {
    for (int round = 0; round < wantedRounds() && !HasFailure(); ++round) {
        const std::string part = kParts[size_t(round) % kParts.size()];
        SCOPED_TRACE("round " + std::to_string(round) + ": " + part);
        startSession(round % 2 == 1);
        pause(kLatest);
        int pid = 0;
        rig_.await(part, [&] { return (pid = pidOf(part)) != 0 || !rig_.session(); });
        ASSERT_NE(pid, 0) << "the session has ended by itself";
        ASSERT_EQ(kill(pid, SIGKILL), 0);
        pause(kAfter);
        if (part != "start_window") {
            EXPECT_TRUE(rig_.window().isRunning()) << "a session takes the window along";
            rig_.window().signal(SIGTERM);
        }
        rig_.window().wait();
        expectNothingLeft();
    }
}

}  // namespace
}  // namespace bonemill
