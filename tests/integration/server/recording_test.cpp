// What a session leaves of itself: it runs again to the bit, and a session that was killed goes on. Server
// and daemon are processes, the test itself is a viewer.
//
// BONEMILL_KILLS says how often a server is killed, 2 without; BONEMILL_ALL_SCENES makes every shipped scene
// run that has its volume.
#include "haptic_server/recording/rerun/recording.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <cstdlib>
#include <memory>
#include <optional>
#include <random>
#include <thread>

#include "common/mcap/mcap_writer.h"
#include "haptic_server/core/telemetry/tick_record.h"
#include "haptic_server/recording/journal/bone_states.h"
#include "haptic_server/recording/journal/journal_reader.h"
#include "haptic_server/recording/rerun/verify_journal.h"
#include "haptic_server/scene/setup/scene_setup.h"
#include "tests/integration/dds/client_probe.h"
#include "tests/integration/server/block_hand.h"
#include "tests/support/every_effect_scene.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;
using test::Finished;
using test::Process;
using test::run;

class Recording : public testing::Test {
  protected:
    void writeBlockScene(const char* law) {
        const test::EveryEffectBlock block;
        test::writeBlock(folder_.path().string(), block);
        // The fixture would hold the burr away from the bone.
        scene::Scene scene = test::withoutEffect(test::everyEffectScene(block, law), "virtual_fixture");
        scene.add_tool()->CopyFrom(scene.tool(0));
        scene.mutable_tool(0)->set_name("large");
        scene.mutable_tool(1)->set_name("small");
        scene.mutable_tool(1)->set_burr_radius_mm(0.6);
        scene.mutable_accuracy()->set_switchable(true);
        test::addHand(scene, block);
        scene_ = folder_ / "scene.textproto";
        test::writeScene(scene_, scene);
    }
    std::vector<std::string> server(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words{"haptic_server", "--scene", scene_,        "--session", session(),
                                       "--domain",      domain(),  "--recording", recordings()};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    std::vector<std::string> daemon() const {
        return {"device_daemon", "--device", "simulated", "--scene", scene_, "--session", session()};
    }
    std::string recordings() const { return folder_ / "recordings"; }
    static std::string session() { return std::to_string(testSession()); }
    static std::string domain() { return std::to_string(testDomain()); }
    // The newest.
    std::string journal() const {
        std::string newest;
        std::filesystem::file_time_type time{};
        std::error_code ignored;
        for (const auto& entry : std::filesystem::directory_iterator(recordings(), ignored))
            if (newest.empty() || entry.last_write_time() >= time)
                newest = entry.path().string(), time = entry.last_write_time();
        return newest;
    }
    static Finished verify(const std::string& journal) {
        return run({"bonemill_lab", "session", "verify", journal});
    }
    static void expectSameBits(const std::string& journal, uint64_t ticks) {
        const Finished verdict = verify(journal);
        EXPECT_EQ(verdict.exit_code, 0) << verdict.out << verdict.err;
        EXPECT_NE(verdict.out.find("the same bits"), std::string::npos) << verdict.out;
        EXPECT_GE(readJournalContent(journal, KeepInputs::kNo).ticks, ticks);
    }

    bool isLive() {
        return probe_->pollUntil(
            [&] { return probe_->subscriber.status() && probe_->subscriber.status()->session_s() > 0.2; });
    }
    bool hasTicked(double seconds) {
        const double until = probe_->subscriber.status()->session_s() + seconds;
        return probe_->pollUntil([&] { return probe_->subscriber.status()->session_s() > until; });
    }
    std::string order(const std::function<void(topics::Command&)>& fill) {
        topics::Command command;
        fill(command);
        return probe_->order(command);
    }
    // Only an instructor may.
    static int tune(const std::string& values) {
        return run({"render_client", "--command", "tune " + values, "--role", "instructor", "--session",
                    session(), "--domain", domain()})
            .exit_code;
    }
    // All that others may decide for a tick, while it mills.
    void orderEverything(const Process& hand) {
        using C = topics::Command;
        EXPECT_TRUE(hasTicked(2));
        most_removed_ = removedMm3();
        EXPECT_EQ(order([](C& c) { c.set_save_checkpoint(true); }), "done");
        EXPECT_TRUE(hasTicked(0.3));
        const std::string tool = order([](C& c) { c.set_select_tool(1); });  // not every scene has two
        EXPECT_TRUE(hasTicked(0.3));
        order([](C& c) { c.set_set_accuracy("fast"); });  // nor is each switchable
        EXPECT_TRUE(hasTicked(0.2));
        EXPECT_EQ(
            tune("coupling { translation_stiffness_n_per_mm: 1.5 } contact { stiffness_n_per_mm3: 300 }"), 0);
        EXPECT_TRUE(hasTicked(0.3));
        EXPECT_EQ(tune("coupling { max_force_n: 2 }"), 0);
        EXPECT_EQ(order([](C& c) { c.set_pause_milling(true); }), "done");
        hand.signal(SIGSTOP);
        EXPECT_TRUE(hasTicked(0.3));
        hand.signal(SIGCONT);
        EXPECT_EQ(order([](C& c) { c.set_pause_milling(false); }), "done");
        EXPECT_EQ(order([](C& c) { c.set_restore_checkpoint(1); }), "done");
        EXPECT_TRUE(hasTicked(0.3));
        EXPECT_EQ(order([](C& c) { c.set_save_checkpoint(true); }), "done");
        order([](C& c) { c.set_set_accuracy("scene"); });
        EXPECT_EQ(tune("scene"), 0);
        if (tool == "done") {
            EXPECT_EQ(order([](C& c) { c.set_select_tool(0); }), "done");
        }
        EXPECT_EQ(order([](C& c) { c.set_start_attempt("Ann"); }), "done");
        EXPECT_TRUE(hasTicked(1));
        EXPECT_EQ(order([](C& c) { c.set_stop_attempt(true); }), "done");
        EXPECT_EQ(order([](C& c) { c.set_reset_volume(true); }), "done");
        EXPECT_TRUE(hasTicked(0.3));
    }
    void runWithOrders() {
        Process live(server()), hand(daemon());
        ASSERT_TRUE(isLive()) << live.errSoFar();
        orderEverything(hand);
        live.signal(SIGTERM);
        const Finished ended = live.wait();
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
    }
    // All that were milled, in their order.
    static std::vector<std::shared_ptr<const BoneSnapshot>> bonesOf(const std::string& journal,
                                                                    const BoneModel& bone) {
        BoneStateReader reader({bone.volume, bone.lattice});
        std::vector<std::shared_ptr<const BoneSnapshot>> bones{nullptr};
        readJournal(journal, [&](JournalTopic topic, const mcap::Message& message) {
            journal::Bone state;
            if (topic != JournalTopic::kBone) return;
            ASSERT_TRUE(state.ParseFromArray(message.data.data(), int(message.data.size())));
            ASSERT_TRUE(reader.add(state));
            if (state.kind() != journal::Bone::OTHER && reader.isComplete()) bones.push_back(reader.state());
        });
        if (bones.size() > 1) bones.erase(bones.begin());
        return bones;
    }
    // The next session begins with the newest bone of the killed one, which is not older than its newest
    // input by more than the bones' period.
    void expectGoesOn(const std::string& killed, const std::string& next, uint64_t ticks) {
        const JournalContent content = readJournalContent(killed, KeepInputs::kNo);
        EXPECT_EQ(content.problem, "") << "it was mended";
        const LoadedScene loaded = recordedScene(content.manifest, killed);
        const SceneSetup simulation = setUpScene(loaded);
        const BoneModel& bone = *simulation.bone;
        const auto newest = bonesOf(killed, bone).back();  // of the bone that is milled, not of checkpoints
        const auto beginning = bonesOf(next, bone).front();
        ASSERT_TRUE(newest && beginning);
        ASSERT_EQ(beginning->leaves.size(), newest->leaves.size());
        for (size_t n = 0; n < beginning->leaves.size(); ++n)
            EXPECT_EQ(beginning->leaves[n]->densities, newest->leaves[n]->densities);
        const JournalContent after = readJournalContent(next, KeepInputs::kNo);
        EXPECT_EQ(after.manifest.resumed_from().tick(), newest->ticks);
        EXPECT_EQ(after.manifest.resumed_from().journal_id(), content.manifest.journal_id());
        const uint64_t lag = ticks > newest->ticks ? ticks - newest->ticks : 0;
        most_lag_ = std::max(most_lag_, lag);
        EXPECT_LT(lag, 1000u) << "with room for a machine that is busy";
    }
    double removedMm3() const {
        const auto& status = probe_->subscriber.status();
        return status ? status->removed_mm3() : -1;
    }

    test::TemporaryFolder folder_;
    std::string scene_;
    std::optional<ClientProbe> probe_{std::in_place};
    uint64_t most_lag_ = 0;
    double most_removed_ = 0;
};

class RecordingOfLaw : public Recording, public testing::WithParamInterface<const char*> {};

TEST_P(RecordingOfLaw, ALiveSessionWithAllOrdersRunsAgainToTheBit) {
    writeBlockScene(GetParam());
    runWithOrders();
    expectSameBits(journal(), 3000);
    const JournalContent content = readJournalContent(journal(), KeepInputs::kYes);
    EXPECT_TRUE(content.has_ended);
    EXPECT_EQ(content.problem, "");
    EXPECT_GE(content.orders.size(), 10u);
    EXPECT_GE(content.put_backs.size(), 3u);
    EXPECT_EQ(content.tunings.size(), 2u);
    uint64_t stale = 0, small = 0, paused = 0, tuned = 0;
    std::vector<JournalTick> ticks;
    for (const journal::Inputs& inputs : content.inputs) ASSERT_TRUE(decodeInputs(inputs, ticks));
    for (const JournalTick& tick : ticks) {
        stale += tick.input.is_stale, small += tick.input.decisions.tool == 1;
        paused += tick.input.decisions.is_milling_paused;
        tuned += tick.input.decisions.tuning != 0;
    }
    EXPECT_GT(most_removed_, 0.05) << "mm3";
    EXPECT_GT(stale, 10u) << "the device was silent for a while";
    EXPECT_GT(small, 100u);
    EXPECT_GT(paused, 100u);
    EXPECT_GT(tuned, 100u);
}

INSTANTIATE_TEST_SUITE_P(Law, RecordingOfLaw, testing::Values(test::kByTime, test::kByEnergy),
                         [](const auto& info) { return std::string(info.param); });

// Another scene than the recorded one gives other bits, and the tick is named: a verdict that is always good
// would say nothing.
TEST_F(Recording, VerifyFindsTheTickThatDiffers) {
    writeBlockScene(test::kByTime);
    {
        Process live(server({"--seconds", "2.5"})), hand(daemon());
        EXPECT_EQ(live.wait().exit_code, 0);
    }
    const std::string good = journal(), bad = folder_ / "bad.mcap";
    mcap::Writer writer(kJournalProfile, "bonemill test");
    readJournal(good, [&, is_first = true](JournalTopic topic, const mcap::Message& message) mutable {
        if (std::exchange(is_first, false))
            for (const JournalTopicName& name : kJournalTopics)
                writer.addChannel({uint16_t(name.topic), 0, std::string(name.name), "protobuf"});
        std::string data(message.data);
        journal::Inputs inputs;
        if (topic == JournalTopic::kInputs && inputs.ParseFromString(data)) {
            std::vector<JournalTick> ticks;
            ASSERT_TRUE(decodeInputs(inputs, ticks));
            for (JournalTick& tick : ticks)
                if (tick.tick == 1234) tick.input.p_WT[2] += 1e-9;
            encodeInputs(ticks, inputs);
            data = inputs.SerializeAsString();
        }
        writer.addMessage(uint16_t(topic), message.time_ns, data);
    });
    writer.finish();
    test::writeFile(bad, writer.take());
    const Finished verdict = verify(bad);
    EXPECT_EQ(verdict.exit_code, 1);
    EXPECT_NE(verdict.out.find("the chain: broken between "), std::string::npos) << verdict.out;
    EXPECT_NE(verdict.out.find("differs from tick 1234 "), std::string::npos) << verdict.out;
    EXPECT_NE(verdict.out.find("the hand's pose"), std::string::npos) << verdict.out;

    const std::string whole = verify(good).out;
    const std::string before_link = "the chain: unbroken, ", last = ", the last is ";
    ASSERT_NE(whole.find(before_link), std::string::npos) << whole;
    const std::string link = whole.substr(whole.find(last) + last.size(), 64);
    const auto verifyAgainst = [&](const std::string& noted) {
        return run({"bonemill_lab", "session", "verify", good, "--chain", noted});
    };
    const Finished noted = verifyAgainst(link), foreign = verifyAgainst(std::string(64, 'F'));
    EXPECT_EQ(noted.exit_code, 0) << noted.out;
    EXPECT_NE(noted.out.find("the link that was noted is that of "), std::string::npos) << noted.out;
    EXPECT_EQ(foreign.exit_code, 1);
    EXPECT_NE(foreign.out.find("the link that was noted is not in it"), std::string::npos) << foreign.out;
    EXPECT_EQ(verifyAgainst("abc").exit_code, 2);

    // The volume is another file, with the same name: it is not read.
    const std::string volume = folder_ / "block.nrrd";
    std::string bytes = test::readFile(volume);
    bytes.back() = char(bytes.back() ^ 1);
    test::writeFile(volume, bytes);
    const Finished other = verify(good);
    EXPECT_EQ(other.exit_code, 2);
    EXPECT_NE(other.err.find("block.nrrd is another file now"), std::string::npos) << other.err;
}

TEST_F(Recording, AKilledSessionGoesOnWithItsBone) {
    writeBlockScene(test::kByTime);
    const char* const wanted = std::getenv("BONEMILL_KILLS");
    const int kills = wanted ? std::atoi(wanted) : 2;
    std::mt19937 random(2026);
    for (int kill = 0; kill < kills; ++kill) {
        std::filesystem::remove_all(recordings());
        probe_.emplace();  // it knows nothing of the session before
        std::string killed;
        {
            Process live(server()), hand(daemon());
            ASSERT_TRUE(isLive()) << live.errSoFar();
            ASSERT_TRUE(probe_->pollUntil([&] { return removedMm3() > 0.05; })) << removedMm3();
            EXPECT_EQ(order([](topics::Command& c) { c.set_save_checkpoint(true); }), "done");
            std::this_thread::sleep_for(std::chrono::microseconds(random() % 1'500'000));
            live.signal(SIGKILL);
            live.wait();
            killed = journal();
        }
        const JournalContent before = readJournalContent(killed, KeepInputs::kNo);
        EXPECT_FALSE(before.has_ended);
        expectSameBits(killed, 500);
        Process resumed(server({"--resume", "--seconds", "1"})), hand(daemon());
        const Finished ended = resumed.wait();
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        EXPECT_NE(ended.err.find("goes on from tick"), std::string::npos) << ended.err;
        const std::string next = journal();
        ASSERT_NE(next, killed);
        expectSameBits(next, 500);
        expectGoesOn(killed, next, before.ticks);
    }
    std::cout << "at most " << most_lag_ << " ticks between the newest bone and the newest input\n";
}

// A server that is started without a word says that there is something, and leaves it.
TEST_F(Recording, TheUserLearnsOfASessionThatWasKilled) {
    writeBlockScene(test::kByTime);
    {
        Process live(server()), hand(daemon());
        ASSERT_TRUE(isLive()) << live.errSoFar();
        ASSERT_TRUE(hasTicked(0.5));
        live.signal(SIGKILL);
        live.wait();
    }
    Process again(server({"--seconds", "0.3"})), hand(daemon());
    const Finished ended = again.wait();
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_NE(ended.err.find("--resume goes on with its bone"), std::string::npos) << ended.err;
}

TEST_F(Recording, NoneIsLeftWhereItIsRefused) {
    writeBlockScene(test::kByTime);
    std::vector<std::string> words = server({"--no-recording", "--seconds", "0.3"});
    words.erase(std::ranges::find(words, "--recording"), std::ranges::find(words, recordings()) + 1);
    Process live(words), hand(daemon());
    EXPECT_EQ(live.wait().exit_code, 0) << live.errSoFar();
    EXPECT_EQ(journal(), "");
}

// The file's limit stands for a disk that is full.
TEST_F(Recording, AFullDiskIsSaidAndHarmsNothing) {
    writeBlockScene(test::kByTime);
    std::vector<std::string> words = server();
    words[0] = test::binDir() + "/haptic_server";
    words.insert(words.begin(), {"/usr/bin/prlimit", "--fsize=150000"});
    Process live(words), hand(daemon());
    ASSERT_TRUE(isLive()) << live.errSoFar();
    ASSERT_TRUE(probe_->pollUntil([&] { return probe_->subscriber.status()->faults() & kFaultNotRecorded; }))
        << live.errSoFar();
    EXPECT_NE(probe_->subscriber.status()->fault_text().find("not_recorded"), std::string::npos);
    const double removed = removedMm3();
    ASSERT_TRUE(probe_->pollUntil([&] { return removedMm3() > removed; })) << "it mills on";
    live.signal(SIGTERM);
    const Finished ended = live.wait();
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_NE(ended.err.find("the recording is incomplete"), std::string::npos) << ended.err;
    expectSameBits(journal(), 200);
}

TEST_F(Recording, EveryShippedSceneRunsAgainToTheBit) {
    if (!std::getenv("BONEMILL_ALL_SCENES")) GTEST_SKIP() << "BONEMILL_ALL_SCENES is not set";
    for (const auto& entry : std::filesystem::directory_iterator(test::sourceDir() + "/deploy/scenes")) {
        if (entry.path().extension() != ".textproto") continue;
        scene_ = entry.path().string();
        SCOPED_TRACE(scene_);
        const Finished described = run({"haptic_server", "--scene", scene_, "--describe-scene"});
        if (described.exit_code != 0) {
            std::cout << scene_ << ": left out, its volume is not there\n";
            continue;
        }
        probe_.emplace();  // the one before still holds the last scene's status
        runWithOrders();
        const Finished verdict = verify(journal());
        std::cout << verdict.out;
        EXPECT_EQ(verdict.exit_code, 0) << verdict.err;
        std::filesystem::remove_all(recordings());
    }
}

}  // namespace
}  // namespace bonemill
