#include <gtest/gtest.h>

#include "render_client/link/subscribe/heard_peers.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;
using Verdict = ServerChoice::Verdict;

constexpr uint64_t kOurs = 1, kOther = 2, kMaxEpoch = UINT64_MAX;
const ServerChoice::Clock::time_point kStart{100s};

ServerChoice::Message status(uint64_t epoch, uint64_t server) {
    return {epoch, server, true};
}
ServerChoice::Message node(uint64_t epoch, uint64_t server) {
    return {epoch, server, false};
}

ServerChoice withOurs() {
    ServerChoice choice;
    EXPECT_EQ(choice.judge(status(10, kOurs), false, kStart), Verdict::kOurs);
    return choice;
}

TEST(ServerChoice, StaysWithTheFirstWhileItLives) {
    ServerChoice choice = withOurs();
    EXPECT_EQ(choice.judge(status(20, kOther), true, kStart), Verdict::kOther);
    EXPECT_TRUE(choice.hasCandidate());
    EXPECT_EQ(choice.judge(node(10, kOurs), true, kStart), Verdict::kOurs);
    EXPECT_EQ(choice.judge(status(20, kOther), false, kStart), Verdict::kOurs) << "ours has gone";
    EXPECT_TRUE(choice.takeLost());
    EXPECT_FALSE(choice.takeLost() || choice.hasCandidate());
    EXPECT_EQ(choice.judge(status(10, kOurs), true, kStart), Verdict::kOther);
}

TEST(ServerChoice, AnOlderOneThatLivesFollowsANewerThatHasGone) {
    ServerChoice choice = withOurs();
    EXPECT_EQ(choice.judge(status(5, kOther), true, kStart), Verdict::kOther);
    EXPECT_EQ(choice.judge(status(5, kOther), false, kStart), Verdict::kOurs);
    EXPECT_EQ(choice.epoch(), 5u);
}

TEST(ServerChoice, AServerMayBeginANewEpochWithAnyOfItsWriters) {
    ServerChoice choice = withOurs();
    EXPECT_EQ(choice.judge(node(20, kOurs), true, kStart), Verdict::kOurs);
    EXPECT_EQ(choice.judge(node(10, kOurs), true, kStart), Verdict::kOlder);
    EXPECT_FALSE(choice.takeLost() || choice.hasCandidate());
}

TEST(ServerChoice, OurEpochLetsNobodyIn) {
    ServerChoice choice = withOurs();
    EXPECT_EQ(choice.judge(node(10, kOther), true, kStart), Verdict::kOther);
    EXPECT_EQ(choice.judge(node(20, kOther), true, kStart), Verdict::kOther);
    EXPECT_FALSE(choice.isOurs(kOther));
}

TEST(ServerChoice, AForgedNodeDoesNotOutliveARestart) {
    ServerChoice choice = withOurs();
    constexpr uint64_t kRestarted = 3;
    EXPECT_EQ(choice.judge(node(kMaxEpoch, kOther), true, kStart), Verdict::kOther);
    EXPECT_EQ(choice.judge(node(kMaxEpoch, kOther), false, kStart), Verdict::kOther);
    EXPECT_EQ(choice.judge(node(20, kRestarted), false, kStart), Verdict::kOther);
    EXPECT_EQ(choice.judge(status(20, kRestarted), false, kStart), Verdict::kOurs);
    EXPECT_TRUE(choice.takeLost()) << "its node was refused";
    EXPECT_EQ(choice.epoch(), 20u);
}

TEST(ServerChoice, WhoHasNeverSpokenMakesRoom) {
    ServerChoice choice;
    EXPECT_EQ(choice.judge(node(kMaxEpoch, kOther), false, kStart), Verdict::kOurs);
    EXPECT_EQ(choice.judge(status(10, kOurs), true, kStart), Verdict::kOurs);
    EXPECT_EQ(choice.judge(node(kMaxEpoch, kOther), true, kStart), Verdict::kOther);
}

TEST(ServerChoice, WhoHasSpokenMaySayAnythingWhenOursIsGone) {
    ServerChoice choice = withOurs();
    choice.judge(status(20, kOther), true, kStart);
    choice.forgetRefused();
    EXPECT_EQ(choice.judge(node(20, kOther), false, kStart), Verdict::kOurs);
    EXPECT_FALSE(choice.takeLost()) << "nothing was refused since the readers were made anew";
}

TEST(ServerChoice, AnotherIsToldOnceItLasts) {
    ServerChoice choice = withOurs();
    choice.judge(status(5, kOther), true, kStart);
    EXPECT_FALSE(choice.hasOther(kStart)) << "a straggler";
    choice.judge(status(5, kOther), true, kStart + 1500ms);
    EXPECT_TRUE(choice.hasOther(kStart + 2s)) << "an older one is another one, too";
    EXPECT_FALSE(choice.hasOther(kStart + 5s)) << "it is gone";
}

TEST(ServerChoice, WhatTheRunBeforeLeftBehindIsNoOtherServer) {
    ServerChoice choice = withOurs();
    choice.judge(status(20, kOther), false, kStart);
    for (int n = 0; n < 4; ++n)
        EXPECT_EQ(choice.judge(node(10, kOurs), true, kStart + n * 1s), Verdict::kOther);
    EXPECT_FALSE(choice.hasOther(kStart + 3s));
}

TEST(ServerChoice, InventedServersAreBoundedAndPushNobodyOut) {
    ServerChoice choice = withOurs();
    for (uint64_t n = 0; n < 100000; ++n) choice.judge(status(n + 1, 1000 + n), true, kStart);
    EXPECT_TRUE(choice.isOurs(kOurs));
    EXPECT_EQ(choice.judge(node(10, kOurs), true, kStart), Verdict::kOurs);
}

}  // namespace
}  // namespace bonemill
