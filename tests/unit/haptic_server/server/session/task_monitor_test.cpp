#include "haptic_server/server/session/task_monitor.h"

#include <gtest/gtest.h>

#include "haptic_server/recording/journal/journal.h"
#include "haptic_server/recording/journal/journal_reader.h"
#include "haptic_server/server/session/attempt_controller.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/core/bone/milled_ball.h"

namespace bonemill {
namespace {

// The ball of bone above z = 8 mm is the target, the rest leeway; half of the target is asked for.
std::shared_ptr<JudgedTask> ballTask(const BoneModel& bone) {
    auto task = std::make_shared<JudgedTask>();
    task->zones = {{"low", ZoneRole::kLeewayBottom}, {"high", ZoneRole::kTarget}};
    std::vector<ZoneId> ids;
    forEachIndex({Eigen::Vector3i::Zero(), bone.volume.dims().array() - 1},
                 [&](const Eigen::Vector3i& v) { ids.push_back(v.z() >= 16 ? 2 : 1); });
    task->map = std::make_shared<const VoxelIds>(bone.volume.dims(), ids);
    task->gates = {{.figure_id = "leeway_bottom.removed_volume", .label = "", .limit = 0, .is_most = true},
                   {.figure_id = "target.removed", .label = "", .limit = 50, .is_most = false}};
    task->scores = {{.figure_id = "target.removed", .label = "", .worst = 0, .best = 100, .weight = 1}};
    task->feedback = TaskFeedback::kLive;
    return task;
}

class TaskWatching : public testing::Test {
  protected:
    TaskWatching() : task_(ballTask(ball_.bone)) {}

    topics::TaskState stateOf(const TaskMonitor& watch, bool is_running, double time_s = 0) const {
        topics::Status status;
        watch.describe(is_running, time_s, status);
        return status.task();
    }

    test::MilledBall ball_;
    std::shared_ptr<JudgedTask> task_;
};

TEST_F(TaskWatching, ASceneWithoutATaskIsNotWatched) {
    TaskMonitor watch(nullptr, ball_.bone, ball_.history);
    watch.round();
    watch.beginAttempt();
    EXPECT_FALSE(watch.endAttempt(ball_.history.snapshot(ball_.bone), {}, {}).valid());
    watch.finish();
    EXPECT_FALSE(watch.showsZones());
    topics::Status status;
    watch.describe(true, 1, status);
    EXPECT_FALSE(status.has_task());
}

TEST_F(TaskWatching, LiveItTellsWhatIsGoneAndHowTheGatesStand) {
    task_->time_limit_s = 60;
    TaskMonitor watch(task_, ball_.bone, ball_.history);
    EXPECT_TRUE(watch.showsZones());
    watch.beginAttempt();
    watch.round();
    topics::TaskState state = stateOf(watch, true, 20);
    EXPECT_EQ(state.time_left_s(), 40);
    ASSERT_EQ(state.zones_size(), 2);
    EXPECT_EQ(state.zones(1).removed_mm3(), 0);
    EXPECT_GT(state.zones(1).bone_mm3(), 100);
    ASSERT_EQ(state.gates_size(), 2);
    EXPECT_EQ(state.gates(0).state(), topics::TaskState::Gate::HELD);
    EXPECT_EQ(state.gates(1).state(), topics::TaskState::Gate::OPEN) << "it has yet to be reached";

    ball_.groove(10e-3);        // in the target
    ball_.groove(10e-3, 5e-3);  // in the leeway
    TaskMonitor late(task_, ball_.bone, ball_.history);
    const double gone = double(ball_.history.missingVoxels()) * 0.125;
    const auto counted = [&] {
        state = stateOf(late, true, 20);
        return state.zones(0).removed_mm3() + state.zones(1).removed_mm3();
    };
    for (int rounds = 0; rounds < 1'000'000 && counted() < gone - 1e-9; ++rounds) late.round();
    EXPECT_NEAR(counted(), gone, 1e-9);
    EXPECT_EQ(state.gates(0).state(), topics::TaskState::Gate::BROKEN);
}

TEST_F(TaskWatching, AnAttemptIsJudgedWhenItHasEnded) {
    TaskMonitor watch(task_, ball_.bone, ball_.history);
    watch.beginAttempt();
    ball_.groove(10e-3);
    const auto judged = watch.endAttempt(ball_.history.snapshot(ball_.bone), 1.5e-3,
                                         {{"force.max", 1, "Largest force", 3, "N"}});
    watch.finish();
    const TaskMonitor::Result* const result = &judged.get();
    EXPECT_EQ(result->problem, "");
    EXPECT_FALSE(result->assessment.hasPassed());
    EXPECT_TRUE(result->assessment.gates[0].is_passed);
    EXPECT_FALSE(result->assessment.gates[1].is_passed);
    EXPECT_EQ(findFigure(result->assessment.figures, "force.max")->value, 3);
    EXPECT_EQ(findFigure(result->assessment.figures, "breach.depth")->value, 1.5);
    EXPECT_NEAR(findFigure(result->assessment.figures, "product.removed_volume")->value,
                double(ball_.history.missingVoxels()) * 0.125, 1e-9);
    const topics::TaskState state = stateOf(watch, false);
    EXPECT_TRUE(state.is_result());
    EXPECT_EQ(state.gates(1).state(), topics::TaskState::Gate::BROKEN);
    EXPECT_TRUE(state.has_score());
    watch.beginAttempt();
    EXPECT_FALSE(stateOf(watch, false).is_result());
}

TEST_F(TaskWatching, AfterwardsZonesShowBetweenAttemptsAndInAnExaminationNever) {
    task_->feedback = TaskFeedback::kAfterwards;
    TaskMonitor watch(task_, ball_.bone, ball_.history);
    EXPECT_FALSE(watch.showsZones());
    EXPECT_EQ(stateOf(watch, true).zones_size(), 0);
    watch.beginAttempt();
    watch.endAttempt(ball_.history.snapshot(ball_.bone), {}, {});
    EXPECT_TRUE(watch.showsZones());
    watch.finish();
    EXPECT_TRUE(stateOf(watch, false).is_result());
    watch.beginAttempt();
    EXPECT_FALSE(watch.showsZones());

    task_->feedback = TaskFeedback::kNever;
    task_->time_limit_s = 60;
    TaskMonitor exam(task_, ball_.bone, ball_.history);
    exam.endAttempt(ball_.history.snapshot(ball_.bone), {}, {});
    exam.finish();
    EXPECT_FALSE(exam.showsZones());
    topics::TaskState only_time;
    only_time.set_time_left_s(59);
    EXPECT_EQ(stateOf(exam, true, 1).SerializeAsString(), only_time.SerializeAsString());
    EXPECT_EQ(stateOf(exam, false).ByteSizeLong(), 0u);
}

class LimitedAttempts : public TaskWatching {
  protected:
    LimitedAttempts() : ring_(16), recorder_(ring_, 1'000'000) {}

    std::string start(AttemptController& attempts, const std::string& trainee) {
        topics::Command order;
        order.set_start_attempt(trainee);
        const auto answer = attempts.start(order);
        return answer ? answer->text : "later";
    }

    SpscRing<TickRecord> ring_;
    Recorder recorder_;
    LessonState lesson_{{}, ClassTable("")};
    JournalRecorder journal_{ball_.history, ball_.bone};  // that goes nowhere
};

TEST_F(LimitedAttempts, EachTraineeHasSoMany) {
    task_->most_attempts = 2;
    TaskMonitor watch(task_, ball_.bone, ball_.history);
    AttemptController attempts(lesson_, recorder_, ball_.history, journal_, ball_.bone, {}, {}, &watch);
    for (int n = 0; n < 2; ++n) {
        EXPECT_NE(start(attempts, "Ann").find("refused"), 0u);
        ball_.restoreAll();
        ball_.groove(10e-3);
        attempts.stop();
    }
    EXPECT_EQ(start(attempts, "Ann"),
              "refused: 'Ann' has had all 2 attempts at this scene (assessment.most_attempts)");
    EXPECT_NE(start(attempts, "Bob").find("refused"), 0u);
    watch.finish();
}

TEST_F(LimitedAttempts, AnAttemptEndsWithItsTime) {
    task_->time_limit_s = 1e-3;
    TaskMonitor watch(task_, ball_.bone, ball_.history);
    AttemptController attempts(lesson_, recorder_, ball_.history, journal_, ball_.bone, {}, {}, &watch);
    start(attempts, "Ann");
    ball_.restoreAll();
    ball_.groove(10e-3);
    while (attempts.isRunning()) attempts.round();
    EXPECT_TRUE(ball_.history.isMillingPaused());
    watch.finish();
    EXPECT_TRUE(stateOf(watch, false).is_result());
}

TEST_F(LimitedAttempts, TheJournalSaysThatOneWasDropped) {
    const test::TemporaryFolder folder;
    JournalConfig config;
    config.path = folder / "j.mcap";
    config.manifest.set_rate_hz(1000);
    const DensitiesAsScanned scanned{ball_.history.scanned(), ball_.bone.lattice};
    Journal journal(config, scanned);
    journal_.begin(&journal, Checkpoints(ball_.history, ball_.bone));
    AttemptController attempts(lesson_, recorder_, ball_.history, journal_, ball_.bone, {});
    start(attempts, "Ann");
    attempts.stop();
    start(attempts, "Bob");
    ball_.restoreAll();
    ball_.groove(10e-3);
    attempts.stop();
    journal.finish();
    std::string events;
    for (const journal::Event& event : readJournalContent(config.path, KeepInputs::kNo).events)
        events += event.has_attempt_began()     ? event.attempt_began() + " "
                  : event.has_attempt_dropped() ? "dropped "
                  : event.has_attempt_ended()   ? "ended "
                                                : "";
    EXPECT_EQ(events, "Ann dropped Bob ended ");
}

TEST_F(LimitedAttempts, OfAnExaminationOnlyTheTimeIsTold) {
    task_->is_exam = true;
    TaskMonitor watch(task_, ball_.bone, ball_.history);
    scene::Scene scene;
    scene.mutable_assessment()->set_exam(true);
    scene.mutable_effects()->mutable_thermal();
    AttemptController attempts(lesson_, recorder_, ball_.history, journal_, ball_.bone, scene, {}, &watch);
    start(attempts, "Ann");
    ball_.restoreAll();
    ball_.groove(10e-3);
    attempts.stop();
    const auto lesson = lesson_.takeChanged();
    ASSERT_TRUE(lesson);
    ASSERT_EQ(lesson->attempts_size(), 1);
    topics::Attempt told = lesson->attempts(0);
    EXPECT_EQ(told.trainee(), "Ann");
    EXPECT_EQ(told.number(), 1u);
    EXPECT_GT(told.start_stamp_ns(), 0);
    EXPECT_TRUE(told.is_exam());
    told.clear_number(), told.clear_trainee(), told.clear_start_stamp_ns(), told.clear_time_s();
    told.clear_is_exam();
    EXPECT_EQ(told.ByteSizeLong(), 0u) << told.ShortDebugString();
    watch.finish();
}

}  // namespace
}  // namespace bonemill
