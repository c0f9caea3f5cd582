#include <gtest/gtest.h>

#include <algorithm>

#include "haptic_server/surface/density_stream/density_stream.h"
#include "proto/topics.pb.h"

namespace bonemill {
namespace {

constexpr uint64_t kEpoch = 77, kSender = 5;
constexpr uint32_t kBricks = 1000;

topics::DensityWish someWish() {
    topics::DensityWish wish;
    wish.set_epoch(kEpoch);
    wish.set_sender(kSender);
    for (const uint32_t brick : {999, 3}) wish.add_lacking(brick);
    for (const uint32_t number : {10, 2, 5, 1}) wish.add_held(number);  // 10, 11 and 17
    for (const uint32_t number : {11, 8}) wish.add_revisions(number);
    return wish;
}

auto parsed(const topics::DensityWish& wish, uint64_t sender = kSender) {
    const std::string bytes = wish.SerializeAsString();
    return parseDensityWish({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, sender, kEpoch,
                            kBricks);
}

TEST(DensityWish, SaysWhatIsLackingAndWhatIsHeld) {
    const std::vector<WishedBrick> expected{
        {999, kLackingBrick}, {3, kLackingBrick}, {10, 0}, {11, 8}, {17, 0}};
    EXPECT_EQ(parsed(someWish()), expected);
}

TEST(DensityWish, IsRefusedIfItCannotBeMeant) {
    const auto refuses = [](auto&& change) {
        topics::DensityWish wish = someWish();
        change(wish);
        return !parsed(wish);
    };
    EXPECT_TRUE(refuses([](auto& wish) { wish.set_epoch(kEpoch + 1); }));
    EXPECT_TRUE(refuses([](auto& wish) { wish.set_sender(6); }));
    EXPECT_TRUE(refuses([](auto& wish) { wish.add_lacking(kBricks); }));
    EXPECT_TRUE(refuses([](auto& wish) { wish.add_held(1); })) << "half a run";
    EXPECT_TRUE(refuses([](auto& wish) { wish.set_held(0, kBricks); })) << "beyond the grid";
    EXPECT_TRUE(refuses([](auto& wish) { wish.set_held(1, ~0u); }));
    EXPECT_TRUE(refuses([](auto& wish) { wish.set_held(0, ~0u); }));
    EXPECT_TRUE(refuses([](auto& wish) { wish.add_revisions(17); })) << "half a revision";
    EXPECT_TRUE(refuses([](auto& wish) { wish.set_revisions(0, 12); })) << "it is not held";
    EXPECT_TRUE(refuses([](auto& wish) { wish.set_revisions(1, kLackingBrick); }));
    EXPECT_TRUE(refuses([](auto& wish) {
        for (int i = 0; i < 2000; ++i) wish.add_lacking(1);
    }));
    topics::DensityWish nobodys = someWish();
    nobodys.set_sender(0);
    EXPECT_FALSE(parsed(nobodys, 0));
    EXPECT_FALSE(parseDensityWish(std::vector<uint8_t>(1 << 20), kSender, kEpoch, kBricks));
}

TEST(DensityWishes, ForgetTheLeastRecentOfTooManyAndTheSilent) {
    DensityWishes wishes;
    constexpr uint64_t kInvented = 10'000;
    for (uint64_t sender = 1; sender <= kInvented; ++sender) {
        wishes.receive(sender, sender, {{1, 0}}, int64_t(sender));
        ASSERT_LE(wishes.wishes().size(), DensityWishes::kMaxSenders);
    }
    for (const auto& wish : wishes.wishes()) EXPECT_GT(wish.sender, kInvented - DensityWishes::kMaxSenders);
    wishes.receive(kInvented, kInvented, {{2, 0}}, kInvented + 1);
    EXPECT_EQ(wishes.wishes().size(), DensityWishes::kMaxSenders) << "a sender has one wish";
    wishes.receive(kInvented, kInvented, {}, kInvented + 2);
    wishes.forgetSilent(kInvented + 2);
    EXPECT_EQ(wishes.wishes().size(), DensityWishes::kMaxSenders - 1) << "who shows none is forgotten";
    wishes.forgetSilent(kInvented + DensityWishes::kSilence_ns);
    EXPECT_TRUE(wishes.wishes().empty());
}

// A participant that invents senders has its share of the list, and others have theirs.
TEST(DensityWishes, OfWhoInventsSendersDriveOutNobodyElses) {
    DensityWishes wishes;
    wishes.receive(1, 7, {{1, 0}}, 1);
    wishes.receive(1, 8, {}, 2);
    EXPECT_EQ(wishes.wishes().at(0).bricks.size(), 1u) << "nobody else speaks for it";
    for (uint64_t sender = 100; sender < 3000; ++sender)
        wishes.receive(sender, 8 + sender % 5, {{2, 0}}, int64_t(sender));
    EXPECT_EQ(wishes.wishes().size(), DensityWishes::kMaxSenders);
    EXPECT_TRUE(std::ranges::any_of(wishes.wishes(), [](const auto& wish) { return wish.sender == 1; }));
}

}  // namespace
}  // namespace bonemill
