#include "haptic_server/recording/statistics/run_statistics.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/base/user_error.h"
#include "common/rt/clock.h"
#include "tests/unit/haptic_server/recording/statistics/temporary_file.h"

namespace bonemill {
namespace {

constexpr int64_t kPeriodNs = kNsPerMillisecond;

// Returns tick `tick` of a 1 kHz run, begun `late_ns` after it was due in period `period`.
TickRecord recordOf(uint64_t tick, int64_t period, int64_t late_ns = 0) {
    TickRecord record{};
    record.tick = tick;
    record.start_ns = 77 * kNsPerSecond + period * kPeriodNs + late_ns;
    record.wakeup_latency_ns = late_ns;
    record.force_ns = 1000;
    record.compute_ns = 2000;
    return record;
}

TEST(RunStatistics, isAllZeroWithoutRecords) {
    const RunStatistics statistics(kPeriodNs);
    EXPECT_EQ(statistics.ticks(), 0u);
    EXPECT_EQ(statistics.meanRateHz(), 0.0);
    EXPECT_EQ(statistics.meanContacts(), 0.0);
    EXPECT_EQ(nlohmann::json::parse(statistics.toJson())["ticks"], 0);
}

TEST(RunStatistics, perfectScheduleHasItsNominalRate) {
    RunStatistics statistics(kPeriodNs);
    for (uint64_t i = 0; i < 2501; ++i) statistics.add(recordOf(i, int64_t(i)));
    EXPECT_EQ(statistics.ticks(), 2501u);
    EXPECT_DOUBLE_EQ(statistics.durationS(), 2.5);
    EXPECT_DOUBLE_EQ(statistics.meanRateHz(), 1000.0);
    EXPECT_EQ(statistics.ratesHz(), (std::vector<double>{1000, 1000}));
    EXPECT_EQ(statistics.droppedTicks(), 0u);
}

TEST(RunStatistics, missedPeriodsAreDroppedTicks) {
    RunStatistics statistics(kPeriodNs);
    uint64_t tick = 0;
    for (int64_t period = 0; period <= 3000; ++period) {
        const bool is_missed = period == 100 || period == 101 || (period >= 1500 && period < 1510);
        if (!is_missed) statistics.add(recordOf(tick++, period));
    }
    EXPECT_EQ(statistics.droppedTicks(), 12u);
    EXPECT_EQ(statistics.ratesHz(), (std::vector<double>{998, 990, 1000}));
    EXPECT_DOUBLE_EQ(statistics.meanRateHz(), (3001 - 12 - 1) / 3.0);
}

TEST(RunStatistics, lateWakeupsAreLatencyAndNotDroppedTicks) {
    RunStatistics statistics(kPeriodNs);
    for (uint64_t i = 0; i < 1000; ++i)
        statistics.add(recordOf(i, int64_t(i), i % 10 == 0 ? 700'000 : 5'000));
    EXPECT_EQ(statistics.droppedTicks(), 0u);
    EXPECT_EQ(statistics.wakeupLatency().maxNs(), 700'000);
    EXPECT_NEAR(double(statistics.wakeupLatency().percentileNs(50)), 5'000, 50);
}

TEST(RunStatistics, lostRecordsAreNoDroppedTicks) {
    RunStatistics statistics(kPeriodNs);
    for (uint64_t i = 0; i <= 2000; ++i) {
        if (i % 100 < 90 || i == 2000) statistics.add(recordOf(i, int64_t(i)));
    }
    statistics.setLostRecords(200);
    EXPECT_EQ(statistics.droppedTicks(), 0u);
    EXPECT_EQ(statistics.lostRecords(), 200u);
    EXPECT_EQ(statistics.ticks(), 2001u);
    EXPECT_DOUBLE_EQ(statistics.meanRateHz(), 1000.0);
    EXPECT_EQ(statistics.ratesHz().size(), 2u);
}

TEST(RunStatistics, aSilentSecondHasRateZero) {
    RunStatistics statistics(kPeriodNs);
    statistics.add(recordOf(0, 0));
    statistics.add(recordOf(1, 2500));
    EXPECT_EQ(statistics.ratesHz(), (std::vector<double>{1, 0}));
    EXPECT_EQ(statistics.droppedTicks(), 2499u);
}

TickRecord millingTick(uint64_t tick) {
    TickRecord record = recordOf(tick, int64_t(tick));
    record.contacts = uint32_t(10 * tick);
    record.f_hand_W[0] = 3.0 * double(tick);
    record.f_hand_W[2] = -4.0 * double(tick);
    record.t_hand_W[1] = -0.1 * double(tick);
    record.max_penetration = 1e-4 * double(tick);
    record.removed = 1e-9;
    record.removed_voxels = 3;
    record.added = 5e-10;
    record.added_voxels = 1;
    if (tick == 2) record.faults = kFaultForceClamped;
    if (tick >= 3) record.faults = kFaultForceClamped | kFaultOverrun;
    return record;
}

TEST(RunStatistics, sumsMaterialAndKeepsExtremes) {
    RunStatistics statistics(kPeriodNs);
    for (uint64_t i = 0; i <= 4; ++i) statistics.add(millingTick(i));
    EXPECT_DOUBLE_EQ(statistics.meanContacts(), 20.0);
    EXPECT_EQ(statistics.maxContacts(), 40u);
    EXPECT_DOUBLE_EQ(statistics.maxForce(), 20.0);
    EXPECT_DOUBLE_EQ(statistics.maxTorque(), 0.4);
    EXPECT_DOUBLE_EQ(statistics.maxPenetration(), 4e-4);
    EXPECT_DOUBLE_EQ(statistics.removed(), 5e-9);
    EXPECT_DOUBLE_EQ(statistics.added(), 2.5e-9);
    EXPECT_EQ(statistics.removedVoxels(), 15u);
    EXPECT_EQ(statistics.addedVoxels(), 5u);
    EXPECT_EQ(statistics.faults(), kFaultForceClamped | kFaultOverrun);
}

TEST(RunStatistics, jsonHoldsTheSameNumbersInPublicUnits) {
    RunStatistics statistics(kPeriodNs);
    for (uint64_t i = 0; i <= 4; ++i) statistics.add(millingTick(i));
    const TemporaryFile file("statistics.json");
    statistics.writeJson(file.path());
    const auto json = nlohmann::json::parse(file.content());
    EXPECT_EQ(json["ticks"], 5);
    EXPECT_DOUBLE_EQ(json["mean_rate_hz"], 1000.0);
    EXPECT_DOUBLE_EQ(json["nominal_rate_hz"], 1000.0);
    EXPECT_DOUBLE_EQ(json["tick_compute_us"]["max"], 2.0);
    EXPECT_DOUBLE_EQ(json["force_ready_us"]["p50"], 1.0);
    EXPECT_DOUBLE_EQ(json["penetration_max_mm"], 0.4);
    EXPECT_DOUBLE_EQ(json["removed_mm3"], 5.0);
    EXPECT_EQ(json["contacts_max"], 40);
    EXPECT_EQ(json["fault_ticks"], (nlohmann::json{{"overrun", 2}, {"force_clamped", 3}}));
}

TEST(RunStatistics, jsonSaysHowLongCutsWaitedForThePublisher) {
    RunStatistics statistics(kPeriodNs);
    for (uint64_t tick = 0; tick < 5; ++tick) {
        TickRecord record = recordOf(tick, int64_t(tick));
        if (tick >= 2) record.cut = cutOf({{0, 0, 0}, {0, 0, 0}}, record.start_ns);
        statistics.add(record);
    }
    EXPECT_FALSE(nlohmann::json::parse(statistics.toJson()).contains("cut_to_publisher_ms"));
    LatencyHistogram waits;
    waits.record(2'000'000);
    waits.record(4'500'000);
    statistics.setCutToPublisher(waits);
    const auto json = nlohmann::json::parse(statistics.toJson());
    EXPECT_EQ(json["cuts"], 3);
    EXPECT_EQ(json["cuts_at_publisher"], 2);
    EXPECT_NEAR(json["cut_to_publisher_ms"]["p50"], 2.0, 0.02);
    EXPECT_DOUBLE_EQ(json["cut_to_publisher_ms"]["p99"], 4.5);
    EXPECT_DOUBLE_EQ(json["cut_to_publisher_ms"]["max"], 4.5);
}

TEST(RunStatistics, whatWasPublishedIsInTheReport) {
    RunStatistics statistics(kPeriodNs);
    statistics.add(recordOf(1, 1));
    EXPECT_FALSE(nlohmann::json::parse(statistics.toJson()).contains("publish_round_ms"));
    PublishFigures published{{}, {}, 3, 0x0123456789abcdef};
    published.rounds.record(2'000'000);
    published.rounds.record(7'500'000);
    published.writes.record(1'250'000);
    statistics.setPublished(published);
    const auto json = nlohmann::json::parse(statistics.toJson());
    EXPECT_DOUBLE_EQ(json["publish_round_ms"]["max"], 7.5);
    EXPECT_NEAR(json["publish_round_ms"]["p50"], 2.0, 0.02);
    EXPECT_DOUBLE_EQ(json["node_write_ms"]["max"], 1.25);
    EXPECT_EQ(json["published_nodes"], 3);
    EXPECT_EQ(json["published_digest"], "0123456789abcdef");
}

TEST(RunStatistics, unwritableReportIsAUserError) {
    EXPECT_THROW(RunStatistics(kPeriodNs).writeJson("/no/such/folder/report.json"), UserError);
}

}  // namespace
}  // namespace bonemill
