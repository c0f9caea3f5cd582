#include <gtest/gtest.h>

#include "haptic_server/server/replay/survey.h"

namespace bonemill {
namespace {

std::shared_ptr<const BoneSnapshot> boneOf(size_t densities) {
    auto bone = std::make_shared<BoneSnapshot>();
    bone->leaves.push_back(std::make_shared<const LeafCopy>(LeafCopy{0, 2, std::vector<Density>(densities)}));
    return bone;
}

TEST(Keyframes, TheLastOneThatIsNotBehind) {
    Keyframes keyframes({{0, nullptr}, {100, boneOf(1)}});
    keyframes.add({50, boneOf(1)});
    EXPECT_EQ(keyframes.before(0).tick, 0u);
    EXPECT_EQ(keyframes.before(49).tick, 0u);
    EXPECT_EQ(keyframes.before(50).tick, 50u);
    EXPECT_EQ(keyframes.before(99).tick, 50u);
    EXPECT_EQ(keyframes.before(1u << 20).tick, 100u);
}

TEST(Keyframes, ThinOutWhereTheyTakeTooMuchAndKeepTheFirstOne) {
    constexpr size_t kMax = 64 * 1000;
    Keyframes keyframes({{0, nullptr}}, kMax * sizeof(Density));
    for (uint64_t tick = 1; tick < 2000; ++tick) keyframes.add({tick, boneOf(1000)});
    EXPECT_LT(keyframes.size(), 200u);
    EXPECT_GT(keyframes.size(), 30u);
    EXPECT_EQ(keyframes.before(0).tick, 0u);
    EXPECT_EQ(keyframes.before(0).bone, nullptr);
    EXPECT_LT(keyframes.before(1000).tick, 1001u);
}

TEST(Keyframes, BonesThatShareTheirLeavesCostNothing) {
    const auto bone = boneOf(1000);
    Keyframes keyframes({{0, nullptr}}, 5000 * sizeof(Density));
    for (uint64_t tick = 1; tick < 500; ++tick) keyframes.add({tick, bone});
    EXPECT_EQ(keyframes.size(), 500u);
}

}  // namespace
}  // namespace bonemill
