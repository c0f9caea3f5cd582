// A viewer that is slow, stopped, dead or cut off harms neither the loop nor the viewers beside it, and shows
// the server's model when it is well again.
#include <signal.h>

#include <thread>

#include "tests/integration/network/network_session.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;
using test::Host;
using test::Process;
using test::Words;

constexpr int kLongestStall_ms = 1000;

class Harmless : public test::NetworkSession {
  protected:
    // The server, and a viewer beside the bad ones on a PC of its own.
    void startWithGoodViewer() {
        startServer(kLab);
        good_pc_ = std::make_unique<Host>(network_->addHost());
        good_ = probe(*good_pc_, kLab);
        ASSERT_TRUE(waitFor([&] { return isWhole(*good_); })) << good_->errSoFar();
    }
    // The good viewer never stood still, the loop and the publisher never waited, all show what was
    // published.
    void expectNoHarm(const std::vector<const Process*>& recovered) {
        const auto all = [&] {
            std::vector<const Process*> probes = recovered;
            probes.insert(probes.begin(), good_.get());
            return probes;
        }();
        EXPECT_TRUE(waitFor([&] { return agree(all); }));
        const auto good = newest(*good_);
        EXPECT_LT(good["longest_age_ms"], kLongestStall_ms) << good;
        EXPECT_LT(good["longest_behind_ms"], kLongestStall_ms) << good;
        EXPECT_GT(good["changes"], 100) << good;
        const auto report = stopServer();
        for (const Process* probe : all) EXPECT_EQ(newest(*probe)["digest"], report["published_digest"]);
        EXPECT_LT(report["publish_round_ms"]["max"], kLongestStall_ms);
        EXPECT_LT(report["publish_round_ms"]["p99"], 100);
        EXPECT_EQ(report["lost_records"], 0);
        EXPECT_FALSE(report["fault_ticks"].contains("solve")) << report["fault_ticks"];
        std::cout << good << "\npublish_round_ms " << report["publish_round_ms"] << " dropped "
                  << report["dropped_ticks"] << " of " << report["ticks"] << std::endl;
    }

    const Words kLab{"--profile", "lab", "--interface", "eth0"};
    std::unique_ptr<Host> good_pc_;
    std::unique_ptr<Process> good_;
};

TEST_F(Harmless, StoppedAndKilledViewers) {
    startWithGoodViewer();
    const Host pc = network_->addHost();
    const auto stopped = probe(pc, kLab), killed = probe(pc, kLab);
    ASSERT_TRUE(waitFor([&] { return isWhole(*stopped) && isWhole(*killed); }));
    startMilling(6);
    std::this_thread::sleep_for(1500ms);
    killed->signal(SIGKILL);
    stopped->signal(SIGSTOP);
    std::this_thread::sleep_for(3s);
    stopped->signal(SIGCONT);
    waitForDevice();
    expectNoHarm({stopped.get()});
}

TEST_F(Harmless, ViewersBehindSlowAndLossyLines) {
    startWithGoodViewer();
    const Host slow_pc = network_->addHost({.rate_kbit_per_s = 1000, .delay_ms = 20});
    const Host lossy_pc = network_->addHost({.delay_ms = 5, .loss_per_mille = 20});
    const auto slow = probe(slow_pc, kLab), lossy = probe(lossy_pc, kLab);
    startMilling(5);
    waitForDevice();
    expectNoHarm({slow.get(), lossy.get()});
}

// Longer than the lease of 4 s: server and viewer have given each other up in between.
TEST_F(Harmless, AViewerThatIsCutOffComesBack) {
    startWithGoodViewer();
    const Host pc = network_->addHost();
    const auto cut_off = probe(pc, kLab);
    ASSERT_TRUE(waitFor([&] { return isWhole(*cut_off); }));
    startMilling(8);
    std::this_thread::sleep_for(1s);
    pc.unplug();
    ASSERT_TRUE(waitFor([&] { return newest(*cut_off)["server"] == false; }));
    std::this_thread::sleep_for(5s);
    pc.plugIn();
    waitForDevice();
    expectNoHarm({cut_off.get()});
}

}  // namespace
}  // namespace bonemill
