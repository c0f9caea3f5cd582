#include "haptic_server/server/replay/comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <thread>

#include "common/base/user_error.h"
#include "haptic_server/teaching/attempt_report/attempt_result.h"
#include "tests/support/recorded_session.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;

constexpr double kShift = 1.5e-3;  // m, along y, of the other way
constexpr double kBall = 1.05e-3;  // m, the burr's radius and a little more

// Two recordings of one scene: of the other one the attempt begins at tick 500, of the first at 200.
class ComparisonTest : public testing::Test {
  protected:
    ComparisonTest()
        : shown_(test::recordSession(folder_.path(),
                                     {.has_orders = false, .file = "a.mcap", .attempts = {200}})),
          other_(test::recordSession(folder_.path(), {.ticks = 2000,
                                                      .has_orders = false,
                                                      .file = "b.mcap",
                                                      .shift = kShift,
                                                      .attempts = {100, 500}})),
          recording_(shown_.journal),
          other_recording_(other_.journal) {}

    void writeResult(const std::string& name, const std::string& journal, const std::string& who,
                     double duration_s) {
        AttemptResult result;
        result.pseudonym = who;
        result.scene_hash = "0123456789abcdef";
        result.duration_s = duration_s;
        result.journal = journal;
        std::filesystem::create_directories(folder_ / "classes/group/results");
        std::ofstream(folder_ / ("classes/group/results/" + name + ".json")) << resultJson(result);
    }
    AttemptFolders folders() const { return {folder_ / "classes", folder_.path()}; }
    std::string problemOf(const AttemptName& name) {
        try {
            openCompared(name, folders(), recording_);
            return "";
        } catch (const UserError& error) {
            return error.what();
        }
    }

    test::TemporaryFolder folder_;
    test::RecordedSession shown_, other_;
    Recording recording_, other_recording_;
};

TEST_F(ComparisonTest, InBothTheSameTimeHasPassedSinceTheBeginning) {
    const AttemptClock clock(recording_, other_recording_, {"P2", 0, 500, UINT64_MAX, {}});
    for (const uint64_t tick : {200u, 201u, 700u, 1500u}) {
        const uint64_t other = clock.otherTickAt(tick);
        EXPECT_NEAR(clock.attemptS(other), recording_.secondsOf(tick) - recording_.secondsOf(200), 1.1e-3)
            << tick;
        EXPECT_NEAR(double(other), double(tick) + 300, 1) << tick;
    }
    EXPECT_EQ(clock.otherTickAt(0), 500u) << "before the attempt";
    EXPECT_EQ(clock.otherTickAt(2999), 1999u) << "when the other one has ended";
    EXPECT_NEAR(clock.lengthS(), 1.499, 1e-4);
    const AttemptClock ended(recording_, other_recording_, {"P1", 0, 100, 500, 0.4});
    EXPECT_EQ(ended.otherTickAt(2999), 500u) << "what comes after the attempt is none of it";
    const AttemptClock whole(other_recording_, recording_, {});
    EXPECT_NEAR(double(whole.otherTickAt(499)), 399, 1) << "the first attempt";
    EXPECT_EQ(whole.otherTickAt(500), 0u) << "with the next attempt it begins anew";
}

TEST_F(ComparisonTest, AnAttemptIsFoundByItsNumberOrItsResult) {
    EXPECT_EQ(openCompared({other_.journal, 0}, {}, recording_).attempt.begin, 500u);
    const ComparedAttempt first = openCompared({other_.journal, 1}, {}, recording_);
    EXPECT_EQ(first.attempt.begin, 100u);
    EXPECT_EQ(first.attempt.end, 500u);
    EXPECT_EQ(first.text.substr(0, 4), "P1, ");
    writeResult("first", "b.mcap", "P1", 0.4);
    EXPECT_EQ(openCompared({resultOfName(folders(), "first"), 0}, folders(), recording_).attempt.begin, 100u);
    writeResult("second", "b.mcap", "P2", 1.5);
    EXPECT_EQ(openCompared({resultOfName(folders(), "second"), 0}, folders(), recording_).attempt.begin, 500u)
        << "the recording ended before it";
}

TEST_F(ComparisonTest, WhatCannotBeComparedIsSaidInOneLine) {
    const auto expect = [&](const std::string& problem, const std::string& part) {
        EXPECT_NE(problem.find(part), std::string::npos) << problem;
        EXPECT_EQ(problem.find('\n'), std::string::npos) << problem;
    };
    expect(problemOf({folder_ / "none.mcap", 0}), "none.mcap");
    std::ofstream(folder_ / "broken.mcap") << "no recording";
    expect(problemOf({folder_ / "broken.mcap", 0}), "broken.mcap");
    std::ofstream(folder_ / "broken.json") << "{";
    expect(problemOf({folder_ / "broken.json", 0}), "broken.json");
    expect(problemOf({other_.journal, 7}), "has 2 attempts, not 7");
    writeResult("gone", "gone.mcap", "P1", 0.4);
    expect(problemOf({resultOfName(folders(), "gone"), 0}), "gone.mcap is not there");
    writeResult("unrecorded", "", "P1", 0.4);
    expect(problemOf({resultOfName(folders(), "unrecorded"), 0}), "was not recorded");
    writeResult("foreign", "b.mcap", "P3", 0.4);
    expect(problemOf({resultOfName(folders(), "foreign"), 0}), "is not in");
    writeResult("longer", "b.mcap", "P1", 0.5);
    expect(problemOf({resultOfName(folders(), "longer"), 0}), "is not in");
    writeResult("escaping", "../b.mcap", "P1", 0.4);
    EXPECT_EQ(problemOf({resultOfName(folders(), "escaping"), 0}), "") << "only the file's name counts";
    EXPECT_THROW(resultOfName(folders(), "nobody"), UserError);
}

TEST_F(ComparisonTest, AnotherSceneOrScanIsRefused) {
    test::RecordedSessionOptions options{.ticks = 100, .has_orders = false};
    const auto recorded = [&](const std::string& name, const std::string& scene, double volume) {
        const std::filesystem::path folder = folder_ / name;
        std::filesystem::create_directories(folder);
        options.scene_text = scene;
        options.top = volume;
        return test::recordSession(folder, options).journal;
    };
    const std::string other_scene = problemOf({recorded("scene", "loop { rate_hz: 500 }", 10e-3), 0});
    EXPECT_NE(other_scene.find("in another version"), std::string::npos) << other_scene;
    const std::string other_scan = problemOf({recorded("scan", "", 9e-3), 0});
    EXPECT_NE(other_scan.find("volume.path was another file"), std::string::npos) << other_scan;
    EXPECT_EQ(problemOf({recorded("same", "", 10e-3), 0}), "");
}

// A replay, and what goes along with it.
class ComparedReplay : public ComparisonTest {
  protected:
    ComparedReplay()
        : scene_(recording_.scene()),
          simulation_(setUpScene(scene_)),
          bones_(recording_.readBones(*simulation_.bone)),
          keyframes_(bones_.keyframes),
          events_(recording_),
          survey_(recording_, simulation_, scene_, bones_, keyframes_, events_),
          rerun_(recording_, simulation_, bones_.checkpoints, *simulation_.bone, bones_.keyframes.front()),
          player_(recording_, rerun_, keyframes_, events_, survey_,
                  simulation_.bone->volume.geometry().X_WV.inverse(), ring_, cuts_),
          comparison_({recording_, simulation_, scene_, rerun_.history().scanned(), player_}, folders()) {
        topics::SceneInfo info;
        comparison_.extend(info);
        EXPECT_EQ(info.materials_size(), 3);
        player_.play(false);
        threads_[0] = std::jthread([this](const std::stop_token& stop) { player_.run(stop); });
        threads_[1] = std::jthread([this](const std::stop_token& stop) { comparison_.run(stop); });
    }
    // The limit only ends a test that hangs.
    template <class Condition>
    bool waitFor(Condition condition) {
        for (int n = 0; n < 30'000; ++n) {
            TickRecord record;
            while (ring_.tryPop(record)) {
            }
            Cut cut;
            while (cuts_.tryPop(cut)) {
            }
            if (condition()) return true;
            std::this_thread::sleep_for(1ms);
        }
        return false;
    }
    topics::Comparison now() const {
        topics::Replay replay;
        comparison_.describe(replay);
        return replay.comparison();
    }
    void seek(uint64_t tick) {
        topics::ReplayOrder order;
        order.set_seek_s(recording_.secondsOf(tick) + 1e-9);
        player_.carryOut(order);
        ASSERT_TRUE(waitFor([&] { return player_.shown() == tick; }));
    }
    // The other tool is where it was then, in its recording.
    bool goesAlongAt(uint64_t shown_tick, uint64_t other_tick, double nearness) {
        return waitFor([&] {
            const std::optional<Pose> X_WT = comparison_.otherTool();
            return player_.shown() == shown_tick && X_WT &&
                   std::abs(X_WT->position.x() - other_.x_m[other_tick]) < nearness &&
                   std::abs(X_WT->position.y() - other_.y_m[other_tick]) < nearness;
        });
    }

    LoadedScene scene_;
    SceneSetup simulation_;
    Recording::Bones bones_;
    Keyframes keyframes_;
    ReplayEvents events_;
    Survey survey_;
    Rerun rerun_;
    SpscRing<TickRecord> ring_{8192};
    SpscRing<Cut> cuts_{8192};
    Player player_;
    Comparison comparison_;
    std::array<std::jthread, 2> threads_;
};

TEST_F(ComparedReplay, TheOtherToolGoesAlongWhereverTheReplayIsLed) {
    comparison_.compareWith(openCompared({other_.journal, 0}, {}, recording_));
    const AttemptClock clock(recording_, other_recording_, {"P2", 0, 500, UINT64_MAX, {}});
    for (const uint64_t tick : {1500u, 250u, 2999u, 700u, 0u}) {
        seek(tick);
        // After a jump the tool settles as that of the replay does.
        EXPECT_TRUE(goesAlongAt(tick, clock.otherTickAt(tick), 50e-6))
            << tick << ": " << comparison_.otherTool().value_or(Pose{}).position.transpose();
    }
    EXPECT_EQ(now().problem(), "");
    EXPECT_NEAR(now().length_s(), 1.499, 1e-4);
}

TEST_F(ComparedReplay, PlayedFromItsBeginningItComesToTheSameBits) {
    comparison_.compareWith(openCompared({other_.journal, 1}, {}, recording_));
    ASSERT_TRUE(waitFor([&] { return comparison_.otherTool().has_value(); }));
    topics::ReplayOrder order;
    order.set_speed(4);
    player_.carryOut(order);
    player_.play(true);
    ASSERT_TRUE(waitFor([&] { return player_.shown() == 2999; }));
    EXPECT_TRUE(goesAlongAt(2999, 500, 1e-15)) << "to the end of the other attempt, tick by tick";
}

TEST_F(ComparedReplay, WhatGoesWrongIsSaidAndTheReplayGoesOn) {
    writeResult("gone", "none.mcap", "P2", 1.5);
    EXPECT_EQ(comparison_.compareWithResult("gone").outcome, topics::DONE);
    ASSERT_TRUE(waitFor([&] { return !now().problem().empty(); }));
    EXPECT_NE(now().problem().find("none.mcap"), std::string::npos);
    EXPECT_FALSE(comparison_.otherTool());
    EXPECT_EQ(comparison_.showDifference(true).outcome, topics::REFUSED);
    seek(1200);
    EXPECT_EQ(comparison_.compareWithResult("nobody").outcome, topics::DONE);
    EXPECT_TRUE(waitFor([&] { return now().problem().find("'nobody'") != std::string::npos; }));
    EXPECT_EQ(comparison_.compareWithResult("../b").outcome, topics::REFUSED);
    writeResult("told", "b.mcap", "P2", 1.5);
    EXPECT_EQ(comparison_.compareWithResult("told").outcome, topics::DONE);
    EXPECT_TRUE(goesAlongAt(1200, 1500, 50e-6));
    EXPECT_EQ(comparison_.showDifference(true).outcome, topics::DONE);
    EXPECT_TRUE(comparison_.paint());
    EXPECT_TRUE(now().shows_difference());
    comparison_.compareWithNone();
    EXPECT_TRUE(waitFor([&] { return now().attempt().empty() && !comparison_.otherTool(); }));
    EXPECT_FALSE(comparison_.paint());
}

TEST_F(ComparedReplay, TheColoursFollowBothBones) {
    comparison_.compareWith(openCompared({other_.journal, 0}, {}, recording_));
    comparison_.showDifference(true);
    ASSERT_TRUE(waitFor([&] { return comparison_.paint() && comparison_.otherTool(); }));
    seek(2999);
    ASSERT_TRUE(goesAlongAt(2999, 1999, 50e-6));
    const std::shared_ptr<const VertexPaint> paint = comparison_.paint();
    const VoxelVolume& bone = simulation_.bone->volume;
    std::array<int, 4> seen{};  // none, here, there, both
    forEachIndex({Eigen::Vector3i::Zero(), bone.dims().array() - 2}, [&](const Eigen::Vector3i& v) {
        const Eigen::Vector3i above = v + Eigen::Vector3i::UnitZ();
        if (bone.at(v.x(), v.y(), v.z()) < bone.iso() ||
            bone.at(above.x(), above.y(), above.z()) >= bone.iso())
            return;
        const uint8_t number = paint->between(v, above);
        ASSERT_LT(number, seen.size());
        ++seen[number];
        const double y = double(v.y()) * bone.spacing().y() + bone.geometry().X_WV.position.y();
        if (number == 1) {
            EXPECT_LT(y, std::ranges::max(shown_.y_m) + kBall);
        }
        if (number == 2) {
            EXPECT_GT(y, std::ranges::min(other_.y_m) - kBall);
        }
    });
    for (const int count : seen) EXPECT_GT(count, 20);
}

}  // namespace
}  // namespace bonemill
