#include "haptic_server/server/replay/player.h"

#include <gtest/gtest.h>

#include <thread>

#include "tests/support/recorded_session.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;

// A replay without anything around it.
class PlayerTest : public testing::Test {
  protected:
    PlayerTest()
        : session_(test::recordSession(folder_.path())),
          recording_(session_.journal),
          scene_(recording_.scene()),
          simulation_(setUpScene(scene_)),
          bones_(recording_.readBones(*simulation_.bone)),
          keyframes_(bones_.keyframes),
          events_(recording_),
          survey_(recording_, simulation_, scene_, bones_, keyframes_, events_),
          rerun_(recording_, simulation_, bones_.checkpoints, *simulation_.bone, bones_.keyframes.front()),
          player_(recording_, rerun_, keyframes_, events_, survey_,
                  simulation_.bone->volume.geometry().X_WV.inverse(), ring_, cuts_) {
        player_.play(false);
        survey_.start();
        thread_ = std::jthread([this](const std::stop_token& stop) { player_.run(stop); });
    }

    // The limit only ends a test that hangs.
    template <class Condition>
    bool waitFor(Condition condition) {
        for (int n = 0; n < 30'000; ++n) {
            TickRecord record;
            while (ring_.tryPop(record)) newest_ = record;
            Cut cut;
            while (cuts_.tryPop(cut)) {
            }
            if (condition()) return true;
            std::this_thread::sleep_for(1ms);
        }
        return false;
    }
    bool arrives() {
        return waitFor([this] { return !now().is_seeking(); });
    }
    topics::Replay now() const {
        topics::Replay replay;
        player_.describe(replay);
        return replay;
    }
    std::string seek(double seconds) {
        topics::ReplayOrder order;
        order.set_seek_s(seconds);
        return player_.carryOut(order).text;
    }
    std::string jump(int by) {
        topics::ReplayOrder order;
        order.set_jump(by);
        return player_.carryOut(order).text;
    }
    std::string when(const Eigen::Vector3d& p_W) {
        topics::ReplayOrder order;
        order.mutable_removal_at()->mutable_p_m()->Assign(p_W.begin(), p_W.end());
        return player_.carryOut(order).text;
    }
    std::string speed(double factor) {
        topics::ReplayOrder order;
        order.set_speed(factor);
        return player_.carryOut(order).text;
    }

    test::TemporaryFolder folder_;
    test::RecordedSession session_;
    Recording recording_;
    LoadedScene scene_;
    SceneSetup simulation_;
    Recording::Bones bones_;
    Keyframes keyframes_;
    ReplayEvents events_;
    Survey survey_;
    Rerun rerun_;
    SpscRing<TickRecord> ring_{8192};
    SpscRing<Cut> cuts_{8192};
    TickRecord newest_{};
    Player player_;
    std::jthread thread_;
};

TEST_F(PlayerTest, GoesToAnyMomentAndTellsItsTick) {
    for (const uint64_t tick : {2000u, 300u, 2999u, 0u, 1500u}) {
        ASSERT_EQ(seek(recording_.secondsOf(tick) + 1e-9), "done");
        ASSERT_TRUE(arrives());
        EXPECT_EQ(player_.shown(), tick);
        ASSERT_TRUE(waitFor([&] { return newest_.t_s == recording_.secondsOf(tick); })) << newest_.t_s;
        EXPECT_NEAR(newest_.p_WT[0], session_.x_m[tick], 50e-6);
    }
    EXPECT_EQ(seek(1e6), "done");
    ASSERT_TRUE(arrives());
    EXPECT_EQ(player_.shown(), 2999u);
    EXPECT_EQ(seek(-1).substr(0, 7), "refused");
    EXPECT_EQ(seek(std::nan("")).substr(0, 7), "refused");
}

TEST_F(PlayerTest, NumbersOfRecordsGrowWhereverItGoes) {
    uint64_t last = 0;
    for (const double moment : {2.0, 1.0, 0.0}) {
        seek(moment);
        ASSERT_TRUE(arrives());
        ASSERT_TRUE(waitFor([&] { return newest_.tick > last || moment == 2.0; }));
        last = newest_.tick;
    }
}

TEST_F(PlayerTest, PlaysToTheEndAndBeginsAnew) {
    EXPECT_EQ(speed(16), "done");
    player_.play(true);
    ASSERT_TRUE(waitFor([&] { return !now().is_playing(); }));
    EXPECT_EQ(player_.shown(), 2999u);
    EXPECT_TRUE(waitFor([&] { return newest_.p_WT[0] == session_.x_m[2999]; }))
        << "it has run all ticks: to the bit; " << newest_.p_WT[0] << " and not " << session_.x_m[2999];
    EXPECT_EQ(rerun_.history().missingVoxels(), session_.missing_voxels[2999]);
    EXPECT_EQ(speed(0.1), "done");
    player_.play(true);
    ASSERT_TRUE(waitFor([&] { return player_.shown() < 2900; }));
    EXPECT_TRUE(now().is_playing());
    player_.play(false);
}

TEST_F(PlayerTest, RefusesSpeedsThatItDoesNotHave) {
    for (const double factor : {0.0, 0.09, 16.1, -1.0, std::nan("")})
        EXPECT_EQ(speed(factor).substr(0, 7), "refused");
    EXPECT_EQ(now().speed(), 1);
}

TEST_F(PlayerTest, JumpsFromEventToEvent) {
    std::vector<uint64_t> found;
    while (jump(1) == "done") {
        ASSERT_TRUE(arrives());
        found.push_back(player_.shown());
        ASSERT_LT(found.size(), 100u);
        EXPECT_FALSE(now().event().empty());
    }
    for (const uint64_t order : {test::kTickOfCheckpoint, test::kTickOfOtherTool, test::kTickOfReset,
                                 test::kTickOfPause, test::kTickOfPause + 100, test::kTickOfRestore})
        EXPECT_NE(std::ranges::find(found, order), found.end()) << order;
    EXPECT_EQ(found.back(), 2999u) << "the end";
    ASSERT_EQ(jump(-1), "done");
    ASSERT_TRUE(arrives());
    EXPECT_EQ(player_.shown(), test::kTickOfRestore);
    EXPECT_NE(now().event().find("restore_checkpoint 1"), std::string::npos) << now().event();
}

TEST_F(PlayerTest, FindsWhenBoneWasRemoved) {
    ASSERT_TRUE(waitFor([&] { return survey_.known() == recording_.ticks(); }));
    // In the middle of the way, where the ball is 0.4 mm deep.
    const uint64_t tick = 700;
    const Eigen::Vector3d burr_W(session_.x_m[tick], 8e-3, 9.9e-3);
    seek(1.2);
    ASSERT_TRUE(arrives());
    ASSERT_EQ(when(burr_W), "done");
    ASSERT_TRUE(arrives());
    const uint64_t at = player_.shown();
    EXPECT_LE(at, tick);
    EXPECT_NEAR(session_.x_m[at], burr_W.x(), 1.2e-3) << "the burr of 1 mm was there";
    EXPECT_GT(session_.missing_voxels[at], session_.missing_voxels[at - 1]);
    EXPECT_NE(now().event().find("in tick " + std::to_string(at)), std::string::npos) << now().event();
    EXPECT_EQ(when({0, 0, 0}).substr(0, 7), "refused");
    EXPECT_EQ(when({0, std::nan(""), 1e9}).substr(0, 7), "refused");
    EXPECT_EQ(player_.carryOut({}).outcome, topics::REFUSED);
}

}  // namespace
}  // namespace bonemill
