#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "haptic_server/recording/statistics/run_statistics.h"

namespace bonemill {
namespace {

DeviceReport statusOf(SafetyState state, StopCause cause = StopCause::kNone, uint32_t fault_code = 0) {
    return {uint32_t(state), uint32_t(cause), fault_code, 0};
}

TEST(DeviceHistory, KeepsWhatChangesAndNothingElse) {
    DeviceHistory history;
    history.add(0, statusOf(SafetyState::kEngaged));
    EXPECT_EQ(history.count(), 0u);
    history.add(1, statusOf(SafetyState::kProtectiveStop, StopCause::kSpeed));
    DeviceReport same = statusOf(SafetyState::kProtectiveStop, StopCause::kSpeed);
    same.flags = kDeviceFlagEnabled;
    history.add(2, same);
    history.add(3, statusOf(SafetyState::kReady));
    ASSERT_EQ(history.kept().size(), 2u);
    EXPECT_EQ(history.kept()[0].t_s, 1);
    EXPECT_EQ(history.kept()[1].now.state, uint32_t(SafetyState::kReady));
}

TEST(DeviceHistory, ADeviceThatComesAndGoesWithoutEndIsOnlyCounted) {
    DeviceHistory history;
    for (int n = 0; n < 10'000; ++n)
        history.add(n, statusOf(n % 2 ? SafetyState::kReady : SafetyState::kPaused));
    EXPECT_EQ(history.kept().size(), DeviceHistory::kMaxKept);
    EXPECT_EQ(history.count(), 10'000u);
}

TEST(DeviceHistory, WordsSayWhatHappenedAndWhatToDo) {
    EXPECT_EQ(deviceText(statusOf(SafetyState::kEngaged)), "engaged");
    EXPECT_EQ(deviceText(statusOf(SafetyState::kProtectiveStop, StopCause::kSpeed)),
              std::string("protective stop: too fast. ") + whatToDo(StopCause::kSpeed));
    EXPECT_EQ(causeText(statusOf(SafetyState::kFault, StopCause::kDeviceFault, 17)), "device fault 17");
}

TEST(DeviceHistory, TheReportHasItWhereThereIsAny) {
    RunStatistics statistics(1'000'000);
    TickRecord record{};
    statistics.add(record);
    EXPECT_FALSE(nlohmann::json::parse(statistics.toJson()).contains("device_states"));
    record.tick = 1;
    record.t_s = 0.5;
    record.device = statusOf(SafetyState::kProtectiveStop, StopCause::kPower);
    statistics.add(record);
    const auto json = nlohmann::json::parse(statistics.toJson());
    EXPECT_EQ(json["device_changes"], 1);
    EXPECT_EQ(json["device_states"], (nlohmann::json{{{"t_s", 0.5},
                                                      {"state", "protective stop"},
                                                      {"cause", "too much power"},
                                                      {"what_to_do", whatToDo(StopCause::kPower)}}}));
}

}  // namespace
}  // namespace bonemill
