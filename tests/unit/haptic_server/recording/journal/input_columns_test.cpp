#include "haptic_server/recording/journal/input_columns.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

#include "tests/support/mutated_bytes.h"
#include "tests/unit/haptic_server/recording/journal/recorded_ticks.h"

namespace bonemill {
namespace {

std::vector<JournalTick> ticksOf(const std::vector<TickRecord>& records) {
    std::vector<JournalTick> ticks;
    for (const TickRecord& record : records)
        ticks.push_back(journalTickOf(record, records.front().start_ns, uint16_t(record.tick * 977)));
    return ticks;
}

template <class Field>
bool isSameBytes(const Field& a, const Field& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

void expectSame(const JournalTick& a, const JournalTick& b) {
    EXPECT_EQ(a.tick, b.tick);
    EXPECT_EQ(a.start_ns, b.start_ns);
    EXPECT_EQ(a.buttons, b.buttons);
    EXPECT_TRUE(isSameBytes(a.device, b.device));
    EXPECT_EQ(a.check, b.check);
    const TickInput &x = a.input, &y = b.input;
    EXPECT_TRUE(isSameBytes(x.p_WT, y.p_WT) && isSameBytes(x.q_WT, y.q_WT)) << "tick " << a.tick;
    EXPECT_TRUE(isSameBytes(x.stale_factor, y.stale_factor));
    EXPECT_EQ(x.placements, y.placements);
    EXPECT_EQ(x.faults, y.faults);
    EXPECT_EQ(x.periods, y.periods);
    EXPECT_EQ(x.is_repeated, y.is_repeated);
    EXPECT_EQ(x.is_stale, y.is_stale);
    EXPECT_EQ(x.has_other_device, y.has_other_device);
    EXPECT_TRUE(isSameBytes(x.other_device, y.other_device));
    EXPECT_EQ(x.decisions.tool, y.decisions.tool);
    EXPECT_EQ(x.decisions.accuracy, y.decisions.accuracy);
    EXPECT_EQ(x.decisions.tuning, y.decisions.tuning);
    EXPECT_EQ(x.decisions.is_milling_paused, y.decisions.is_milling_paused);
    EXPECT_EQ(x.decisions.is_write_refused, y.decisions.is_write_refused);
    EXPECT_EQ(x.decisions.is_milling_put_off, y.decisions.is_milling_put_off);
    EXPECT_EQ(x.decisions.is_heat_put_off, y.decisions.is_heat_put_off);
    EXPECT_EQ(x.decisions.milling_thrift, y.decisions.milling_thrift);
    EXPECT_EQ(x.decisions.most_samples, y.decisions.most_samples);
    EXPECT_EQ(x.decisions.bone_order, y.decisions.bone_order);
}

void expectSame(const std::vector<JournalTick>& a, const std::vector<JournalTick>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (size_t n = 0; n < a.size(); ++n) expectSame(a[n], b[n]);
}

std::vector<JournalTick> thereAndBack(const std::vector<JournalTick>& ticks) {
    journal::Inputs inputs, read;
    encodeInputs(ticks, inputs);
    EXPECT_TRUE(read.ParseFromString(inputs.SerializeAsString()));
    std::vector<JournalTick> back;
    EXPECT_TRUE(decodeInputs(read, back));
    return back;
}

TEST(InputColumns, GiveEveryTickBackToTheBit) {
    const auto ticks = ticksOf(test::recordedTicks(kMaxTicksPerInputs));
    expectSame(thereAndBack(ticks), ticks);
    const std::vector<JournalTick> later(ticks.begin() + 500, ticks.begin() + 601);
    expectSame(thereAndBack(later), later);
    const std::vector<JournalTick> one(ticks.begin() + 1, ticks.begin() + 2);
    expectSame(thereAndBack(one), one);
}

// Most sessions are not tuned, and none of before was: then the column is not there.
TEST(InputColumns, GiveBackWhatWasTuned) {
    auto ticks = ticksOf(test::recordedTicks(400));
    journal::Inputs inputs;
    encodeInputs(ticks, inputs);
    EXPECT_FALSE(inputs.has_tuning());
    for (size_t n = 150; n < ticks.size(); ++n) ticks[n].input.decisions.tuning = uint32_t(1 + n / 200);
    expectSame(thereAndBack(ticks), ticks);
    encodeInputs(ticks, inputs);
    EXPECT_EQ(inputs.tuning().values_size(), 3);
    inputs.mutable_tuning()->set_values(1, uint64_t(1) << 32);
    std::vector<JournalTick> none;
    EXPECT_FALSE(decodeInputs(inputs, none));
}

// A device may say anything; the tick refuses it, and so must its replay.
TEST(InputColumns, GiveBackWhatIsNoPose) {
    auto ticks = ticksOf(test::recordedTicks(64));
    const double odd[] = {std::numeric_limits<double>::quiet_NaN(),
                          -0.0,
                          0.0,
                          std::numeric_limits<double>::infinity(),
                          -std::numeric_limits<double>::infinity(),
                          std::numeric_limits<double>::denorm_min(),
                          1e300,
                          -1e300};
    std::mt19937 random(7);
    for (JournalTick& tick : ticks) {
        tick.input.p_WT[random() % 3] = odd[random() % 8];
        tick.input.q_WT[random() % 4] = odd[random() % 8];
    }
    expectSame(thereAndBack(ticks), ticks);
}

// Of the quaternion's w next to nothing is left when the other three are known.
TEST(InputColumns, PredictTheQuaternionsLastNumber) {
    journal::Inputs inputs;
    encodeInputs(ticksOf(test::recordedTicks(1000)), inputs);
    const std::string& planes = inputs.qw();
    const auto zeros = std::count(planes.begin() + 2000, planes.end(), '\0');
    EXPECT_GT(zeros, 5990) << "only the two lowest bytes differ, but for the first tick's";
}

TEST(InputColumns, RefuseWhatTheyDidNotMake) {
    journal::Inputs good;
    encodeInputs(ticksOf(test::recordedTicks(100)), good);
    std::vector<JournalTick> ticks(3);
    const auto refused = [&](auto change) {
        journal::Inputs bad = good;
        change(bad);
        EXPECT_FALSE(decodeInputs(bad, ticks));
        EXPECT_EQ(ticks.size(), 3u);
    };
    refused([](journal::Inputs& bad) { bad.set_count(101); });
    refused([](journal::Inputs& bad) { bad.set_count(UINT32_MAX); });
    refused([](journal::Inputs& bad) { bad.set_count(0); });
    refused([](journal::Inputs& bad) { bad.mutable_px()->pop_back(); });
    refused([](journal::Inputs& bad) { bad.mutable_checks()->push_back('x'); });
    refused([](journal::Inputs& bad) { bad.add_start_ns_steps(1); });
    refused([](journal::Inputs& bad) { bad.set_start_ns_steps(5, INT64_MAX); });
    refused([](journal::Inputs& bad) { bad.mutable_tool()->set_lengths(0, 99); });
    refused([](journal::Inputs& bad) { bad.mutable_tool()->add_values(1); });
    refused([](journal::Inputs& bad) { bad.mutable_tool()->set_values(0, uint64_t(1) << 32); });
    refused([](journal::Inputs& bad) { bad.mutable_flags()->set_values(0, 256); });
    refused([](journal::Inputs& bad) { bad.mutable_periods()->set_values(0, 0); });
    refused([](journal::Inputs& bad) { bad.mutable_stale_factor_bits()->set_values(0, ~uint64_t(0)); });
    refused([](journal::Inputs& bad) { bad.mutable_other_devices(0)->set_tick(100); });
    refused([](journal::Inputs& bad) { bad.mutable_other_devices(0)->mutable_capabilities()->pop_back(); });
    refused([](journal::Inputs& bad) { bad.set_first_tick(UINT64_MAX); });
}

TEST(InputColumns, NoMessageOfAnybodysMakesATickThatCannotBe) {
    std::mt19937 random(3);
    journal::Inputs good;
    encodeInputs(ticksOf(test::recordedTicks(40)), good);
    const std::string bytes = good.SerializeAsString();
    int taken = 0;
    for (int round = 0; round < 20'000; ++round) {
        journal::Inputs inputs;
        if (!inputs.ParseFromString(test::mutated(bytes, random))) continue;
        std::vector<JournalTick> ticks;
        if (!decodeInputs(inputs, ticks)) continue;
        ++taken;
        for (const JournalTick& tick : ticks) {
            EXPECT_TRUE(tick.input.stale_factor >= 0 && tick.input.stale_factor <= 1);
            EXPECT_GE(tick.input.periods, 1);
            EXPECT_TRUE(!tick.input.has_other_device || isPlausible(tick.input.other_device));
        }
    }
    EXPECT_GT(taken, 1000);
}

}  // namespace
}  // namespace bonemill
