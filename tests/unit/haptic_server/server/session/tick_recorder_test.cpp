#include "haptic_server/server/session/tick_recorder.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

constexpr int64_t kPeriodNs = 1'000'000;

class RecorderTest : public testing::Test {
  protected:
    void pushTicks(int count) {
        for (int n = 0; n < count; ++n) {
            TickRecord record{};
            record.tick = tick_++;
            ring_.tryPush(record);
        }
    }
    int traceLines() const {
        std::ifstream file(trace_);
        int lines = 0;
        for (std::string line; std::getline(file, line);) ++lines;
        return lines;
    }

    test::TemporaryFolder folder_;
    const std::string trace_ = folder_ / "trace.csv";
    SpscRing<TickRecord> ring_{4};
    uint64_t tick_ = 0;
};

TEST_F(RecorderTest, ATraceWithAllTicksIsWhole) {
    Recorder recorder(ring_, kPeriodNs);
    recorder.openTrace(trace_);
    pushTicks(4);
    recorder.drain();
    pushTicks(4);
    EXPECT_TRUE(recorder.finish());
    EXPECT_EQ(traceLines(), 1 + 8);
    EXPECT_EQ(recorder.statistics().lostRecords(), 0u);
}

TEST_F(RecorderTest, GivesEveryTickOnceToWhoAsksOften) {
    Recorder recorder(ring_, kPeriodNs);
    const auto drain = [&](int ticks) {
        pushTicks(ticks);
        recorder.drain();
    };
    drain(4);
    EXPECT_TRUE(recorder.takeAll().empty()) << "nobody had asked";
    drain(3), drain(2);
    const std::vector<TickRecord> taken = recorder.takeAll();
    ASSERT_EQ(taken.size(), 5u);
    for (size_t i = 0; i < 5; ++i) EXPECT_EQ(taken[i].tick, 4 + i);
    EXPECT_TRUE(recorder.takeAll().empty());
    for (size_t n = 0; n <= Recorder::kMostKept; ++n) drain(1);
    EXPECT_TRUE(recorder.takeAll().empty()) << "whoever asked has gone";
    drain(1);
    EXPECT_EQ(recorder.takeAll().size(), 1u);
}

TEST_F(RecorderTest, EachChangeOfTheDeviceIsGivenOnce) {
    Recorder recorder(ring_, kPeriodNs);
    const auto push = [&](SafetyState state) {
        TickRecord record{};
        record.tick = tick_++;
        record.device.state = uint32_t(state);
        ring_.tryPush(record);
    };
    push(SafetyState::kReady), push(SafetyState::kReady), push(SafetyState::kEngaged);
    recorder.drain();
    push(SafetyState::kPaused);
    recorder.drain();
    const auto changes = recorder.takeDeviceChanges();
    ASSERT_EQ(changes.size(), 3u);
    EXPECT_EQ(changes[2].now.state, uint32_t(SafetyState::kPaused));
    EXPECT_TRUE(recorder.takeDeviceChanges().empty());
}

// Records of the attempt before are still on their way when the next one begins.
TEST_F(RecorderTest, AnAttemptCountsFromWhereItsBoneIsPutBack) {
    Recorder recorder(ring_, kPeriodNs, {.protection = true});
    const auto push = [&](double force, float damaged, uint64_t bone_order) {
        TickRecord record{};
        record.tick = tick_++;
        record.contacts = 1;
        record.f_hand_W[0] = force;
        record.effects.damaged_volume = damaged;
        record.bone_order = bone_order;
        ring_.tryPush(record);
    };
    push(9, 3, 0);
    recorder.drain();
    recorder.beginAttempt(2);
    push(9, 3, 0), push(9, 0, 1);
    recorder.drain();
    EXPECT_EQ(recorder.attempt().max_force, 0);
    EXPECT_EQ(recorder.attempt().effects.figure("protected_damaged_mm3"), 0);
    push(2, 0, 2), push(1, 1, 2);
    recorder.drain();
    EXPECT_EQ(recorder.attempt().max_force, 2);
    EXPECT_EQ(recorder.attempt().effects.figure("protected_damaged_mm3"), 1e9);
}

// What is measured of an attempt begins with its bone and ends when it is taken.
TEST_F(RecorderTest, AnAttemptIsMeasuredFromWhereItsBoneIsPutBack) {
    Recorder recorder(ring_, kPeriodNs);
    recorder.measureTechnique([] { return std::make_unique<Technique>(TechniqueScene{}); });
    const auto push = [&](uint64_t bone_order) {
        TickRecord record{};
        record.t_s = 1e-3 * double(tick_);
        record.tick = tick_++;
        record.bone_order = bone_order;
        ring_.tryPush(record);
        recorder.drain();
    };
    push(0), push(0);
    EXPECT_EQ(recorder.endAttempt(0).technique, nullptr) << "there is no attempt";
    recorder.beginAttempt(2);
    push(1), push(2), push(2), push(2);
    const std::unique_ptr<Technique> technique = recorder.endAttempt(0).technique;
    ASSERT_NE(technique, nullptr);
    push(2);
    EXPECT_DOUBLE_EQ(technique->beginS(), 3e-3);
    EXPECT_NEAR(findFigure(technique->figures(), "time.session")->value, 2e-3, 1e-12);
    EXPECT_EQ(recorder.endAttempt(0).technique, nullptr);
}

// What was removed, how and when, is all as of the same tick, although ticks go on meanwhile.
TEST_F(RecorderTest, AnAttemptEndsBehindTheTickThatIsSaid) {
    Recorder recorder(ring_, kPeriodNs);
    recorder.measureTechnique([] { return std::make_unique<Technique>(TechniqueScene{}); });
    const auto push = [&] {
        TickRecord record{};
        record.t_s = 1e-3 * double(tick_);
        record.tick = tick_++;
        record.contacts = 1;
        record.f_hand_W[0] = double(tick_);
        ring_.tryPush(record);
        recorder.drain();
    };
    recorder.beginAttempt(0);
    push(), push();
    std::thread later([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        for (int n = 0; n < 10; ++n) push();
    });
    const EndedAttempt ended = recorder.endAttempt(5);
    later.join();
    EXPECT_EQ(ended.figures.max_force, 5);

    EXPECT_NEAR(findFigure(ended.technique->figures(), "time.session")->value, 4e-3, 1e-12);
    EXPECT_EQ(recorder.endAttempt(1000).technique, nullptr) << "ticks that do not come are not waited for";
}

TEST_F(RecorderTest, ATraceThatLacksTicksIsNotWhole) {
    Recorder recorder(ring_, kPeriodNs);
    recorder.openTrace(trace_);
    pushTicks(7);  // the ring has room for four
    recorder.drain();
    pushTicks(2);
    EXPECT_FALSE(recorder.finish());
    EXPECT_EQ(traceLines(), 1 + 6) << "what is there is in the file all the same";
    EXPECT_EQ(recorder.statistics().lostRecords(), 3u);
}

TEST_F(RecorderTest, ATraceOnAFullDiskIsNotWhole) {
    Recorder recorder(ring_, kPeriodNs);
    recorder.openTrace("/dev/full");
    pushTicks(1);
    EXPECT_FALSE(recorder.finish());
    EXPECT_EQ(recorder.statistics().lostRecords(), 0u);
}

TEST_F(RecorderTest, WithoutATraceNothingOfItIsLost) {
    Recorder recorder(ring_, kPeriodNs);
    pushTicks(7);
    EXPECT_TRUE(recorder.finish());
    EXPECT_EQ(recorder.statistics().lostRecords(), 3u);
}

}  // namespace
}  // namespace bonemill
