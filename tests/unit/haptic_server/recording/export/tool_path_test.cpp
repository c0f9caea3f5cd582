#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>

#include "common/base/user_error.h"
#include "haptic_server/recording/export/export_journal.h"
#include "haptic_server/recording/export/trajectory_writer.h"
#include "haptic_server/scene/trajectory/trajectory_reader.h"
#include "tests/support/recorded_session.h"
#include "tests/support/rewritten_journal.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

constexpr double kPause_s = 1e-3 * test::kTickOfPause;

class ToolPath : public testing::Test {
  protected:
    // From one tick to the other, on the bone that was put back by this order.
    void addAttempt(uint64_t begin, uint64_t end, uint64_t bone_order, bool is_dropped = false) {
        journal::Event began, ended;
        began.set_tick(begin), began.set_attempt_began("ada"), began.set_bone_order(bone_order);
        ended.set_tick(end), ended.mutable_attempt_ended()->set_time_s(double(end - begin) * 1e-3);
        if (is_dropped) ended.mutable_attempt_dropped();
        auto messages = test::journalMessages(session_.journal);
        const auto isEnd = [](const test::JournalMessage& message) {
            return message.topic == JournalTopic::kEvent && message.as<journal::Event>().has_end();
        };
        for (const journal::Event& event : {began, ended})
            messages.insert(std::ranges::find_if(messages, isEnd),
                            {JournalTopic::kEvent, 0, event.SerializeAsString()});
        test::writeJournal(session_.journal, messages, true);
    }
    std::vector<TrajectoryRow> exported(int attempt = 0) {
        exportJournal({.journal = session_.journal,
                       .h5 = "",
                       .csv = "",
                       .traj = "",
                       .tool_path = folder_ / "path.csv",
                       .attempt = attempt});
        return readTrajectory(folder_ / "path.csv");
    }

    test::TemporaryFolder folder_;
    const test::RecordedSession session_ = test::recordSession(folder_.path());
};

TEST_F(ToolPath, WithoutAttemptsItIsTheWholeSessionOfTheSimulatedTool) {
    const auto rows = exported();
    ASSERT_GT(rows.size(), 280u);
    EXPECT_EQ(rows.front().t_s, 0);
    exportJournal({.journal = session_.journal, .h5 = "", .csv = folder_ / "s.csv", .traj = ""});
    std::ifstream file(folder_ / "s.csv");
    std::string line;
    std::getline(file, line);
    double first_s = -1;
    auto row = rows.begin();
    for (double t_s = 0, x_m = 0; std::getline(file, line) && row->t_s < kPause_s;) {
        ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf", &t_s, &x_m), 2);
        if (first_s < 0) first_s = t_s;
        if (std::abs(row->t_s - (t_s - first_s)) > 1e-7) continue;
        EXPECT_NEAR(row->X_WT.position.x(), x_m, 1e-9) << t_s;
        ++row;
    }
    EXPECT_GE(row->t_s, kPause_s) << "every row is a tick's";
}

TEST_F(ToolPath, AnAttemptsTimeRestsInPauses) {
    addAttempt(test::kTickOfReset - 100, test::kTickOfRestore - 50, 1);  // 0.85 s, of which 0.1 s are paused
    addAttempt(test::kTickOfRestore, 2900, 2);
    EXPECT_NEAR(exported().back().t_s, 0.2, 0.03) << "the last one";
    EXPECT_NEAR(exported(1).back().t_s, 0.75, 0.03);
}

TEST_F(ToolPath, AnAttemptThatWasDroppedHasNoNumber) {
    addAttempt(100, 900, 0, true);
    addAttempt(test::kTickOfReset - 100, test::kTickOfRestore - 50, 1);
    addAttempt(test::kTickOfRestore, 2900, 2, true);
    EXPECT_NEAR(exported(1).back().t_s, 0.75, 0.03);
    EXPECT_NEAR(exported().back().t_s, 0.75, 0.03) << "the last that counts";
    EXPECT_THROW(exported(2), UserError);
}

TEST_F(ToolPath, AnAttemptThatIsNotThereIsRefused) {
    EXPECT_THROW(exported(1), UserError);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "path.csv"));
}

}  // namespace
}  // namespace bonemill
