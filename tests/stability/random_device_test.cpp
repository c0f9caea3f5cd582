// Some of the random devices (tests/bench/stability_grid.cpp, --random, tries all), and a light arm of which
// its bridge knows next to nothing: whatever a device says of itself, it comes to rest.
#include <gtest/gtest.h>

#include "tests/stability/loop_point.h"

namespace bonemill::test {
namespace {

const Variant& onBalanced() {
    return allVariants()[2];
}

std::string wordsOf(const LoopVerdict& verdict) {
    return std::to_string(verdict.force_rms * 1e3) + " mN, " + std::to_string(verdict.torque_rms * 1e3) +
           " N mm, share " + std::to_string(verdict.share) + (verdict.is_lost ? ", lost" : "");
}

TEST(RandomDevice, ComesToRestWhateverItSays) {
    constexpr int kEvery = 11;
    for (int n = 0; n < kRandomDevices; n += kEvery)
        for (const Says says : {Says::kTruth, Says::kWrong, Says::kLittle}) {
            const LoopVerdict verdict = tryLoop(randomDevice(n), onBalanced(), says);
            EXPECT_TRUE(verdict.isQuiet()) << n << ' ' << nameOf(says) << ": " << wordsOf(verdict);
        }
}

// 0.13 kg on a plane with a weight of 1 N, and nobody holds it.
LoopPoint lightArm(double delay_ticks, int hand) {
    return {.hand = hand,
            .friction = 0.1,
            .mass = 0.13,
            .damping = 0.3,
            .delay_ticks = int(delay_ticks),
            .late_ticks = delay_ticks - int(delay_ticks),
            .most_force = 5,
            .push = 1,
            .has_torque = false};
}

TEST(LightArm, ThatSaysLittleComesToRestAtEveryDelay) {
    for (const double delay : {1.0, 1.5, 2.0, 2.5, 3.0})
        for (const int hand : {0, 1}) {
            const LoopVerdict verdict = tryLoop(lightArm(delay, hand), onBalanced(), Says::kLittle);
            EXPECT_TRUE(verdict.isQuiet()) << delay << " ticks, hand " << hand << ": " << wordsOf(verdict);
        }
}

TEST(LightArm, KeepsItsStiffnessWhereItIsQuiet) {
    for (const double delay : {1.0, 1.5})
        EXPECT_GE(tryLoop(lightArm(delay, 0), onBalanced(), Says::kLittle).share, 0.9) << delay;
}

}  // namespace
}  // namespace bonemill::test
