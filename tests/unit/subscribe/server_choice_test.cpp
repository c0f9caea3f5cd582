#include "render_client/subscribe/server_choice.h"

#include <gtest/gtest.h>

namespace bonemill {
namespace {

using namespace std::chrono_literals;
using Verdict = ServerChoice::Verdict;

const ServerChoice::Clock::time_point kStart{100s};

TEST(ServerChoice, StaysWithTheFirstWhileItLives) {
    ServerChoice choice;
    EXPECT_EQ(choice.judge(10, 1, false, kStart), Verdict::kOurs);
    EXPECT_EQ(choice.judge(20, 2, true, kStart), Verdict::kOther);
    EXPECT_TRUE(choice.isOther(2));
    EXPECT_TRUE(choice.hasRefused());
    EXPECT_EQ(choice.judge(10, 1, true, kStart), Verdict::kOurs);
    EXPECT_EQ(choice.judge(20, 2, false, kStart), Verdict::kOurs) << "ours has gone";
    EXPECT_FALSE(choice.isOther(2));
    EXPECT_EQ(choice.judge(10, 1, true, kStart), Verdict::kOlder);
}

TEST(ServerChoice, AServerMayBeginANewEpoch) {
    ServerChoice choice;
    choice.judge(10, 1, false, kStart);
    EXPECT_EQ(choice.judge(20, 1, true, kStart), Verdict::kOurs);
    EXPECT_FALSE(choice.hasRefused());
}

// A writer that was silent before is only known to be ours once another one has begun the epoch.
TEST(ServerChoice, WhatOurOwnServerWasRefusedIsAskedForAgain) {
    ServerChoice choice;
    choice.judge(10, 1, false, kStart);
    EXPECT_EQ(choice.judge(20, 2, true, kStart), Verdict::kOther);
    EXPECT_FALSE(choice.hasLost());
    EXPECT_EQ(choice.judge(20, 1, true, kStart), Verdict::kOurs);
    EXPECT_TRUE(choice.hasLost());
    choice.forgetWriters();
    EXPECT_FALSE(choice.hasLost() || choice.hasRefused());
    EXPECT_EQ(choice.judge(20, 2, true, kStart), Verdict::kOurs);
}

TEST(ServerChoice, AnotherIsToldOnceItLasts) {
    ServerChoice choice;
    choice.judge(20, 1, false, kStart);
    choice.judge(10, 2, true, kStart);
    EXPECT_FALSE(choice.hasOther(kStart)) << "a straggler";
    choice.judge(10, 2, true, kStart + 1500ms);
    EXPECT_TRUE(choice.hasOther(kStart + 2s)) << "an older one is another one, too";
    EXPECT_FALSE(choice.hasOther(kStart + 5s)) << "it is gone";
}

TEST(ServerChoice, WhatTheRunBeforeLeftBehindIsNoOtherServer) {
    ServerChoice choice;
    choice.judge(10, 1, false, kStart);
    choice.judge(20, 2, false, kStart);
    for (int n = 0; n < 4; ++n) EXPECT_EQ(choice.judge(10, 1, true, kStart + n * 1s), Verdict::kOlder);
    EXPECT_FALSE(choice.hasOther(kStart + 3s));
}

}  // namespace
}  // namespace bonemill
