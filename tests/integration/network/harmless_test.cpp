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
using test::VirtualNetwork;
using test::Words;

constexpr int kLongestStall_ms = 2000;

class Harmless : public test::NetworkSession {
  protected:
    // The server, and a viewer beside the bad ones.
    void startWithGoodViewerOn(const Host& pc) {
        startServer(kLab);
        good_ = probe(pc, kLab);
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
        EXPECT_LT(report["publish_round_ms"]["p99"], 300);
        EXPECT_EQ(report["lost_records"], 0);
        EXPECT_FALSE(report["fault_ticks"].contains("solve")) << report["fault_ticks"];
    }

    const Words kLab{"--profile", "lab", "--interface", "eth0"};
    std::unique_ptr<Process> good_;
};

TEST_F(Harmless, StoppedAndKilledViewers) {
    const Host good_pc = network_->addHost(), bad_pc = network_->addHost();
    startWithGoodViewerOn(good_pc);
    const auto stopped = probe(bad_pc, kLab), killed = probe(bad_pc, kLab);
    ASSERT_TRUE(waitFor([&] { return isWhole(*stopped) && isWhole(*killed); }));
    startMilling(6);
    std::this_thread::sleep_for(1500ms);
    killed->signal(SIGKILL);
    stopped->signal(SIGSTOP);
    std::this_thread::sleep_for(3s);
    stopped->signal(SIGCONT);
    waitForDevice();
    expectNoHarm({stopped.get()});
    EXPECT_GT(newest(*stopped)["longest_behind_ms"], 2000);
}

// What the bone loses does not fit through the slow line: its viewer leaves out what is outdated.
TEST_F(Harmless, ViewersBehindSlowAndLossyLines) {
    if (const std::string missing = VirtualNetwork::missingForLines(); !missing.empty())
        GTEST_SKIP() << missing;
    const Host good_pc = network_->addHost();
    startWithGoodViewerOn(good_pc);
    const Host slow_pc = network_->addHost({.rate_kbit_per_s = 1000, .delay_ms = 20, .queue_kib = 64});
    const Host lossy_pc = network_->addHost({.delay_ms = 5, .loss_per_mille = 20});
    const auto slow = probe(slow_pc, kLab), lossy = probe(lossy_pc, kLab);
    startMilling(3);
    waitForDevice();
    expectNoHarm({slow.get(), lossy.get()});
    EXPECT_LT(newest(*slow)["changes"], newest(*good_)["changes"]);
}

// For longer than the lease of 4 s: server and viewer have given each other up in between.
TEST_F(Harmless, AViewerThatIsCutOffComesBack) {
    const Host good_pc = network_->addHost(), bad_pc = network_->addHost();
    startWithGoodViewerOn(good_pc);
    const auto cut_off = probe(bad_pc, kLab);
    ASSERT_TRUE(waitFor([&] { return isWhole(*cut_off); }));
    startMilling(7);
    std::this_thread::sleep_for(500ms);
    bad_pc.unplug();
    ASSERT_TRUE(waitFor([&] { return newest(*cut_off)["server"] == false; }));
    std::this_thread::sleep_for(2500ms);
    bad_pc.plugIn();
    waitForDevice();
    expectNoHarm({cut_off.get()});
}

// The cable of the haptics PC: all others are cut off, its own viewer goes on.
TEST_F(Harmless, TheHapticsPcCutOffKeepsItsOwnViewer) {
    const Host other_pc = network_->addHost();
    startWithGoodViewerOn(*haptics_pc_);
    const auto cut_off = probe(other_pc, kLab);
    ASSERT_TRUE(waitFor([&] { return isWhole(*cut_off); }));
    startMilling(7);
    std::this_thread::sleep_for(500ms);
    haptics_pc_->unplug();
    ASSERT_TRUE(waitFor([&] { return newest(*cut_off)["server"] == false; }));
    std::this_thread::sleep_for(2500ms);
    haptics_pc_->plugIn();
    waitForDevice();
    expectNoHarm({cut_off.get()});
}

}  // namespace
}  // namespace bonemill
