// Server, daemon and emulator are killed and stopped at random moments, again and again: each time the force
// goes, it does not come back before the enabling switch is pressed anew, and the session goes on when what
// was gone is back. BONEMILL_CHAOS_ROUNDS says how often (docs/explanation/safety.md).
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "tests/integration/device/force_watch.h"
#include "tests/integration/device/tapped_wire.h"
#include "tests/support/dds_session.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;
using test::EnablingSwitch;
using test::Process;

constexpr double kFeltForce = 0.5;  // N, norm over the motors

int roundsWanted() {
    const char* wanted = std::getenv("BONEMILL_CHAOS_ROUNDS");
    return wanted ? std::atoi(wanted) : 10;
}

size_t countOf(const std::string& text, const std::string& word) {
    size_t count = 0;
    for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
    return count;
}

// The simulated hand presses on a slab and mills it for hours. Every packet between daemon and motors is
// watched.
class DeviceChaos : public testing::Test {
  public:
    DeviceChaos() : session_(std::to_string(testSession())), domain_(std::to_string(testDomain())) {
        EXPECT_EQ(
            test::run({"make_phantom", "body", "--kind", "slab", "--out", folder_ / "slab.nrrd"}).exit_code,
            0);
        const std::string upright = "q_WT { w: 0.70710678 x: 0.70710678 }";
        test::writeFile(folder_ / "s.textproto",
                        "name: \"chaos\" volume { path: \"slab.nrrd\" } effects { time_removal { "
                        "rate_density_per_s: 10 } }\n"
                        "device { p_WD_mm { x: 0 y: 0.1 z: 2 } q_WD { w: 0.70710678 x: 0.70710678 } }\n"
                        "simulated_operator { tremor_mm: 0.1\n"
                        "  waypoint { time_s: 0 p_WT_mm { x: 0 y: 0.1 z: 3.6 } " +
                            upright +
                            " phase: \"approach\" }\n"
                            "  waypoint { time_s: 0.3 p_WT_mm { x: 0 y: 0.1 z: 0 } " +
                            upright +
                            " remove: true phase: \"press\" }\n"
                            "  waypoint { time_s: 36000 p_WT_mm { x: 0 y: 0.1 z: -0.1 } " +
                            upright + " } }\n");
        daemon_program_ = wire_.daemonIn(folder_.path());
        startServer();
        startDaemon();
    }
    void startServer() {
        server_.reset();
        server_ = std::make_unique<Process>(std::vector<std::string>{
            "haptic_server", "--scene", folder_ / "s.textproto", "--session", session_, "--domain", domain_});
    }
    void startDaemon() {
        daemon_.reset();
        daemon_ = std::make_unique<Process>(std::vector<std::string>{
            daemon_program_, "--device", "simulated", "--scene", folder_ / "s.textproto", "--session",
            session_, "--stop-dir", folder_ / "stops"});
    }
    // The wire is watched meanwhile. It returns false when the condition never held.
    bool watchUntil(const std::function<bool()>& condition, std::chrono::seconds limit = 40s) {
        return test::waitFor(
            [&] {
                watch_.look(wire_.take());
                return condition();
            },
            limit);
    }
    size_t saidByDaemon(const std::string& words) const {
        return countOf(daemon_->errSoFar() + daemon_->outSoFar(), words);
    }
    size_t engagedSoFar() const { return saidByDaemon("device is engaged"); }
    bool engagesAfter(size_t times) {
        return watchUntil([&] { return engagedSoFar() > times; });
    }
    bool isFelt() const { return watch_.isEngaged() && watch_.orderedForce() > kFeltForce; }
    // The hand presses the switch as often as it needs to, and from then on the switch stays down. A busy
    // machine may stop the device meanwhile; then it is tried once more.
    bool pressAndHoldUnderForce() {
        for (int i = 0; i < 10; ++i) {
            wire_.set(EnablingSwitch::kOfTheHand);
            if (!watchUntil([this] { return isFelt(); })) return false;
            wire_.set(EnablingSwitch::kHeld);
            std::this_thread::sleep_for(20ms);
            watch_.look(wire_.take());
            if (isFelt()) return true;
        }
        return false;
    }
    // Until the hand is engaged again, or for a while nothing has been missing for that but a fresh press:
    // the drive obeys, and the server answers.
    bool comesBackOrCould(int engagements) {
        constexpr int kStates = 600;
        return watchUntil([&] {
            const bool is_all_there =
                !watch_.isEngaged() && watch_.onStates() > kStates &&
                saidByDaemon("haptic_server answers") == saidByDaemon("haptic_server is silent") + 1;
            return is_all_there || watch_.engagements() > engagements;
        });
    }
    int emulatorPid() const {
        const std::string pid = std::to_string(daemon_->pid());
        int child = 0;
        std::ifstream("/proc/" + pid + "/task/" + pid + "/children") >> child;
        return child;
    }

    // Each returns how often the daemon had engaged before.
    size_t killServer() {
        const size_t before = engagedSoFar();
        server_->signal(SIGKILL);
        std::this_thread::sleep_for(200ms);
        startServer();
        return before;
    }
    size_t pauseServer() { return pause(server_->pid()); }
    size_t killDaemon() {
        const int emulator = emulatorPid();
        daemon_->signal(SIGKILL);
        EXPECT_TRUE(test::waitFor([&] { return kill(emulator, 0) != 0; })) << "an orphan";
        startDaemon();
        return 0;
    }
    size_t pauseDaemon() { return pause(daemon_->pid()); }
    size_t killEmulator() {
        const size_t before = engagedSoFar();
        kill(emulatorPid(), SIGKILL);
        return before;
    }
    size_t pauseEmulator() { return pause(emulatorPid()); }
    size_t pause(int pid) {
        const size_t before = engagedSoFar();
        kill(pid, SIGSTOP);
        std::this_thread::sleep_for(400ms);
        kill(pid, SIGCONT);
        return before;
    }

    test::TemporaryFolder folder_;
    std::string session_, domain_, daemon_program_;
    test::TappedWire wire_;
    test::ForceWatch watch_;
    std::unique_ptr<Process> server_, daemon_;

    using Action = size_t (DeviceChaos::*)();
    struct NamedAction {
        const char* name;
        Action act;
    };
    static constexpr NamedAction kActions[] = {
        {"server killed", &DeviceChaos::killServer},     {"server stopped", &DeviceChaos::pauseServer},
        {"daemon killed", &DeviceChaos::killDaemon},     {"daemon stopped", &DeviceChaos::pauseDaemon},
        {"emulator killed", &DeviceChaos::killEmulator}, {"emulator stopped", &DeviceChaos::pauseEmulator}};
};

TEST_F(DeviceChaos, TheSessionGoesOnWhateverDies) {
    std::mt19937 random{uint32_t(getpid())};
    ASSERT_TRUE(engagesAfter(0)) << daemon_->errSoFar();
    for (int round = 0; round < roundsWanted(); ++round) {
        std::this_thread::sleep_for(std::chrono::milliseconds(random() % 1500));
        const NamedAction& action = kActions[size_t(round) % std::size(kActions)];
        SCOPED_TRACE(std::string(action.name) + " in round " + std::to_string(round));
        const size_t before = (this->*action.act)();
        ASSERT_TRUE(engagesAfter(before)) << daemon_->errSoFar() << server_->errSoFar();
        ASSERT_TRUE(server_->isRunning()) << server_->errSoFar();
        ASSERT_TRUE(daemon_->isRunning()) << daemon_->errSoFar();
        ASSERT_EQ(watch_.complaint(), "");
        ASSERT_EQ(watch_.unaskedEngagements(), 0);
    }
    daemon_->signal(SIGTERM);
    const test::Finished daemon = daemon_->wait();
    EXPECT_EQ(daemon.exit_code, 0) << daemon.err;
    server_->signal(SIGTERM);
    EXPECT_EQ(server_->wait().exit_code, 0);
    const size_t line = daemon.out.rfind('{', daemon.out.find("\"ticks\""));
    const nlohmann::json figures = nlohmann::json::parse(daemon.out.substr(line));
    EXPECT_LE(figures["max_force_n"].get<double>(), 50);
    EXPECT_LE(figures["max_torque_nmm"].get<double>(), 1000);
    watch_.look(wire_.take());
    EXPECT_EQ(watch_.complaint(), "");
}

TEST_F(DeviceChaos, AHeldSwitchBringsNoForceBackBeforeItIsPressedAnew) {
    for (const NamedAction& action : kActions) {
        SCOPED_TRACE(action.name);
        ASSERT_TRUE(pressAndHoldUnderForce()) << daemon_->errSoFar();
        const int engagements = watch_.engagements(), ramps = watch_.ramps();
        (this->*action.act)();
        ASSERT_TRUE(comesBackOrCould(engagements)) << daemon_->errSoFar() << server_->errSoFar();
        EXPECT_EQ(watch_.engagements(), engagements) << "the force came back by itself";
        EXPECT_GT(watch_.ramps(), ramps) << "there was no force to take";
        ASSERT_EQ(watch_.complaint(), "");
    }
    EXPECT_TRUE(pressAndHoldUnderForce()) << daemon_->errSoFar();
}

}  // namespace
}  // namespace bonemill
