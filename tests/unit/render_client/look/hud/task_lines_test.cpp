#include <gtest/gtest.h>

#include "render_client/look/hud/effect_lines.h"
#include "tests/support/hud_rows.h"

namespace bonemill {
namespace {

using topics::TaskState;

void addZone(TaskState& task, scene::Task::Role role, double bone_mm3, double removed_mm3) {
    TaskState::Zone& zone = *task.add_zones();
    zone.set_role(uint32_t(role));
    zone.set_bone_mm3(bone_mm3);
    zone.set_removed_mm3(removed_mm3);
}

void addGate(TaskState& task, TaskState::Gate::State state, const std::string& text) {
    task.add_gates()->set_state(state);
    task.mutable_gates(task.gates_size() - 1)->set_text(text);
}

TEST(TaskLines, aTaskThatSaysNothingHasNoLines) {
    EXPECT_TRUE(taskStateRows({}).empty());
}

TEST(TaskLines, zonesOfARoleAreOneLine) {
    TaskState task;
    addZone(task, scene::Task::TARGET, 10, 8);
    addZone(task, scene::Task::TARGET, 30, 0);
    addZone(task, scene::Task::CONTAINER_BOTTOM, 100, 2.5);
    addZone(task, scene::Task::CONTEXT, 100, 50);
    const std::vector<HudRow> rows = taskStateRows(task);
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(test::findRow(rows, "Target")->value, "20 %");  // 8 of 40
    EXPECT_EQ(test::findRow(rows, "Beyond, bottom")->value, "2.50 mm\u00b3");
}

TEST(TaskLines, oneLineTellsWhatIsGoneOfTheTargetOrWhatCameOfIt) {
    TaskState task;
    EXPECT_EQ(taskSummaryRow(task).value, "");
    addZone(task, scene::Task::TARGET, 200, 50);
    addGate(task, TaskState::Gate::HELD, "");
    task.set_time_left_s(61);
    EXPECT_EQ(taskSummaryRow(task).value, "25 %, 0:01:01");
    EXPECT_EQ(taskSummaryRow(task).tone, HudTone::kPlain);
    task.mutable_gates(0)->set_state(TaskState::Gate::BROKEN);
    task.set_is_result(true);
    task.clear_time_left_s();
    EXPECT_EQ(taskSummaryRow(task).value, "failed");
    EXPECT_EQ(taskSummaryRow(task).tone, HudTone::kAlarm);
}

TEST(TaskLines, littleTimeWarnsAndNeverFallsBelowNothing) {
    TaskState task;
    task.set_time_left_s(120);
    EXPECT_EQ(taskStateRows(task)[0].tone, HudTone::kPlain);
    task.set_time_left_s(-4);
    const std::vector<HudRow> rows = taskStateRows(task);
    EXPECT_EQ(rows[0].tone, HudTone::kWarning);
    EXPECT_EQ(rows[0].value.find('-'), std::string::npos);
}

TEST(TaskLines, brokenGatesAreNamedAndAResultSaysWhetherItPassed) {
    TaskState task;
    addGate(task, TaskState::Gate::HELD, "held");
    EXPECT_EQ(test::findRow(taskStateRows(task), "Limits")->value, "all held");
    addGate(task, TaskState::Gate::OPEN, "open");
    EXPECT_EQ(test::findRow(taskStateRows(task), "Limits")->value, "1 of 2 open");
    addGate(task, TaskState::Gate::BROKEN, "broken");
    EXPECT_EQ(test::findRow(taskStateRows(task), "Limits")->value, "1 of 3 broken");
    EXPECT_EQ(taskStateRows(task).size(), 1u);
    task.mutable_gates()->RemoveLast();
    task.set_is_result(true);
    EXPECT_EQ(test::findRow(taskStateRows(task), "Result")->value, "passed");
    for (const char* text : {"one", "two", "three", "four"}) addGate(task, TaskState::Gate::BROKEN, text);
    task.set_score(0.314);
    const std::vector<HudRow> rows = taskStateRows(task);
    EXPECT_EQ(test::findRow(rows, "Result")->value, "failed");
    EXPECT_EQ(test::findRow(rows, "Result")->tone, HudTone::kAlarm);
    EXPECT_NE(test::findRow(rows, "one"), nullptr);
    EXPECT_EQ(test::findRow(rows, "three"), nullptr);
    EXPECT_NE(test::findRow(rows, "and 2 more"), nullptr);
    EXPECT_EQ(test::findRow(rows, "Score")->value, "31 of 100");
}

TEST(TaskLines, ABrokenGateIsSaidInFull) {
    TaskState task;
    task.set_is_result(true);
    addGate(task, TaskState::Gate::BROKEN, "Target: removed: 0 %; at least 80 % were asked for");
    std::string said;
    for (const HudRow& row : taskStateRows(task))
        if (row.label != "Result") said += (said.empty() ? "" : " ") + row.label;
    EXPECT_EQ(said, "Target: removed: 0 %; at least 80 % were asked for");
}

}  // namespace
}  // namespace bonemill
