#include <gtest/gtest.h>

#include "render_client/look/hud/conditions.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;

const Condition kSilence{"silence", "The device sends nothing.", HudTone::kAlarm, true};
const Condition kOverrun{"overrun", "A tick took too long.", HudTone::kWarning, true, false};
const Condition kLimit{"limit", "The force was limited.", HudTone::kPlain, true, false};
const Condition kEnd{"end", "The session has ended."};

class Faults : public testing::Test {
  protected:
    void at(FaultList::Clock::duration time, const std::vector<Condition>& conditions) {
        now_ = FaultList::Clock::time_point(100s) + time;
        book_.observe(conditions, std::chrono::duration<double>(time).count(), now_);
    }
    std::string said() const {
        std::string text;
        for (const HudNotice& notice : book_.said(now_)) text += "|" + notice.text;
        return text;
    }
    float opacity() const { return book_.said(now_).at(0).opacity; }

    FaultList book_;
    FaultList::Clock::time_point now_;
};

TEST_F(Faults, WhatLastsIsSaidUntilItIsOverAndFades) {
    at(0s, {kSilence});
    at(60s, {kSilence});
    EXPECT_EQ(said(), "|" + kSilence.text);
    EXPECT_EQ(opacity(), 1);
    at(61s, {});
    EXPECT_LT(opacity(), 0.5f) << "it was over a second ago at most";
    EXPECT_GT(opacity(), 0.0f);
    at(62s, {});
    EXPECT_EQ(said(), "");
}

TEST_F(Faults, WhatIsOverAtOnceIsStillSaidLongEnoughToBeRead) {
    at(0s, {kSilence});
    at(100ms, {});
    at(FaultList::kShown - 1ms, {});
    EXPECT_EQ(opacity(), 1);
    at(FaultList::kShown + FaultList::kFade, {});
    EXPECT_EQ(said(), "");
}

TEST_F(Faults, WhatTheServerLatchesIsSaidOnce) {
    at(0s, {kOverrun});
    EXPECT_EQ(said(), "|" + kOverrun.text);
    at(FaultList::kShown + FaultList::kFade, {kOverrun});
    EXPECT_EQ(said(), "") << "it is still latched";
    at(1h, {kOverrun});
    EXPECT_EQ(said(), "");
    ASSERT_EQ(book_.faults().size(), 1u);
    EXPECT_EQ(book_.faults()[0].count, 1);
    EXPECT_EQ(book_.faults()[0].last_s, 0);
}

TEST_F(Faults, StayInTheListWithTimeAndCount) {
    at(10s, {kSilence});
    at(11s, {kSilence});
    at(12s, {});
    at(20s, {kSilence, kOverrun});
    at(21s, {kOverrun});
    const auto faults = book_.faults();
    ASSERT_EQ(faults.size(), 2u);
    EXPECT_EQ(faults[0].text, kSilence.text);
    EXPECT_EQ(faults[0].count, 2);
    EXPECT_EQ(faults[0].first_s, 10);
    EXPECT_EQ(faults[0].last_s, 20);
    EXPECT_FALSE(faults[0].lasts);
    EXPECT_EQ(faults[1].first_s, 20);
    book_.clear();
    EXPECT_TRUE(book_.faults().empty());
    EXPECT_EQ(said(), "");
}

// The device's silence lasts, and stays latched when it is over.
TEST_F(Faults, ALatchedFaultThatLastsAgainIsAnother) {
    Condition latched = kSilence;
    latched.lasts = false;
    at(0s, {kSilence});
    at(10s, {latched});
    at(20s, {latched});
    EXPECT_EQ(said(), "");
    at(30s, {kSilence});
    EXPECT_EQ(opacity(), 1);
    EXPECT_EQ(book_.faults().at(0).count, 2);
}

TEST_F(Faults, ALimitThatDidItsWorkIsListedButNotSaid) {
    at(0s, {kLimit});
    EXPECT_EQ(said(), "");
    EXPECT_EQ(book_.faults().size(), 1u);
}

TEST_F(Faults, AnEndIsSaidAndIsNoFault) {
    at(0s, {kEnd});
    EXPECT_EQ(said(), "|" + kEnd.text);
    EXPECT_TRUE(book_.faults().empty());
}

TEST_F(Faults, TheWorstComesFirstAndTheRestIsCounted) {
    at(0s, {kEnd, kOverrun});
    at(1s, {kEnd, kOverrun, kSilence});
    EXPECT_EQ(said(), "|" + kSilence.text + "|and 2 more, listed in the panel");
}

TEST_F(Faults, NoFloodOfNamesFillsTheMemory) {
    std::vector<Condition> flood;
    for (int i = 0; i < 1000; ++i) flood.push_back({std::to_string(i), "x", HudTone::kAlarm, true, false});
    at(0s, flood);
    EXPECT_EQ(book_.faults().size(), FaultList::kMaxKept);
    EXPECT_EQ(book_.said(now_).size(), FaultList::kMaxShown);
}

}  // namespace
}  // namespace bonemill
