// A viewer that is slow, stopped, dead or cut off harms neither the loop nor the viewers beside it, and shows
// the server's model when it is well again. It is judged by what each of them has shown, not by how fast.
#include <signal.h>

#include "tests/integration/network/network_session.h"

namespace bonemill {
namespace {

using test::Host;
using test::Process;
using test::VirtualNetwork;
using test::waitFor;
using test::Words;

constexpr int kSomeChanges = 10;  // of meshes, as a viewer counts them
// A writer that waits for a reader waits so long (kMaxBlocking of common/dds/topic_traits.cpp): no speed is
// judged by it.
constexpr int kMaxBlocking_ms = 1000;

class Harmless : public test::NetworkSession {
  protected:
    // Starts the server, and a viewer beside the bad ones.
    void startWithGoodViewerOn(const Host& pc) {
        startServer(kLab);
        good_ = probe(pc, kLab);
        ASSERT_TRUE(waitFor([&] { return isWhole(*good_); })) << good_->errSoFar();
    }
    static int changesOf(const Process& probe) { return newest(probe)["changes"].get<int>(); }
    // The good viewer goes on: it shows changes that came after it had shown so many.
    bool goodGoesOnAfter(int changes) {
        return waitFor([&] { return changesOf(*good_) > changes + kSomeChanges; });
    }
    // It is behind while it shows another model than the good viewer.
    bool isBehind(const Process& probe) { return newest(probe)["digest"] != newest(*good_)["digest"]; }
    // In the end all show what was published, and no tick was lost on the way.
    void expectNoHarm(const std::vector<const Process*>& recovered) {
        const auto all = [&] {
            std::vector<const Process*> probes = recovered;
            probes.insert(probes.begin(), good_.get());
            return probes;
        }();
        EXPECT_TRUE(waitFor([&] { return agree(all); }));
        EXPECT_GT(changesOf(*good_), kSomeChanges);
        const auto report = stopServer();
        for (const Process* probe : all) EXPECT_EQ(newest(*probe)["digest"], report["published_digest"]);
        EXPECT_LT(report["publish_round_ms"]["max"], kMaxBlocking_ms) << "a viewer held the publisher up";
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
    const int before_milling = changesOf(*stopped);
    startMilling(6);
    ASSERT_TRUE(waitFor([&] { return changesOf(*stopped) > before_milling; }));
    killed->signal(SIGKILL);
    stopped->signal(SIGSTOP);
    EXPECT_TRUE(goodGoesOnAfter(changesOf(*good_)));
    EXPECT_TRUE(isBehind(*stopped));
    stopped->signal(SIGCONT);
    waitForDevice();
    expectNoHarm({stopped.get()});
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

// It is cut off for longer than the lease of 4 s: server and viewer have given each other up in between.
TEST_F(Harmless, AViewerThatIsCutOffComesBack) {
    const Host good_pc = network_->addHost(), bad_pc = network_->addHost();
    startWithGoodViewerOn(good_pc);
    const auto cut_off = probe(bad_pc, kLab);
    ASSERT_TRUE(waitFor([&] { return isWhole(*cut_off); }));
    startMilling(7);
    bad_pc.unplug();
    const int unplugged = changesOf(*good_);
    ASSERT_TRUE(waitFor([&] { return newest(*cut_off)["server"] == false; }));
    EXPECT_TRUE(goodGoesOnAfter(unplugged));
    EXPECT_TRUE(isBehind(*cut_off));
    bad_pc.plugIn();
    waitForDevice();
    expectNoHarm({cut_off.get()});
}

// The cable is that of the haptics PC: all others are cut off, its own viewer goes on.
TEST_F(Harmless, TheHapticsPcCutOffKeepsItsOwnViewer) {
    const Host other_pc = network_->addHost();
    startWithGoodViewerOn(*haptics_pc_);
    const auto cut_off = probe(other_pc, kLab);
    ASSERT_TRUE(waitFor([&] { return isWhole(*cut_off); }));
    startMilling(7);
    haptics_pc_->unplug();
    const int unplugged = changesOf(*good_);
    ASSERT_TRUE(waitFor([&] { return newest(*cut_off)["server"] == false; }));
    EXPECT_TRUE(goodGoesOnAfter(unplugged));
    EXPECT_TRUE(isBehind(*cut_off));
    haptics_pc_->plugIn();
    waitForDevice();
    expectNoHarm({cut_off.get()});
}

}  // namespace
}  // namespace bonemill
