// How many may come from where.
#include <gtest/gtest.h>

#include "render_client/web/gateway/guest_list.h"

namespace bonemill::gateway {
namespace {

constexpr CrowdBounds kCrowd{8, 3, 6};

bool mayCome(const GuestOrigin& comer, const std::vector<GuestOrigin>& there) {
    Crowd crowd(comer);
    for (const GuestOrigin& one : there) crowd.add(one);
    return crowd.hasPlace(kCrowd);
}

TEST(Crowd, OneAddressTakesItsShare) {
    const GuestOrigin one{"192.0.2.1"}, other{"192.0.2.2"};
    EXPECT_TRUE(mayCome(one, {one, one}));
    EXPECT_FALSE(mayCome(one, {one, one, one}));
    EXPECT_TRUE(mayCome(other, {one, one, one}));
    EXPECT_FALSE(mayCome(other, std::vector<GuestOrigin>(8, one)));
}

TEST(Crowd, GuestsOfARelayAreCountedByTheAddressThatItNames) {
    const GuestOrigin one{"192.0.2.1", true}, other{"192.0.2.2", true};
    EXPECT_FALSE(mayCome(one, {one, one, one}));
    EXPECT_TRUE(mayCome(other, {one, one, one}));
    EXPECT_TRUE(mayCome({"192.0.2.1"}, {one, one, one})) << "who comes directly pays for nobody's word";
}

// Whatever addresses it invents.
TEST(Crowd, ARelayLeavesRoomForThoseWhoComeDirectly) {
    std::vector<GuestOrigin> there;
    for (int n = 0; n < 6; ++n) there.push_back({"192.0.2." + std::to_string(n), true});
    EXPECT_FALSE(mayCome({"192.0.2.99", true}, there));
    EXPECT_TRUE(mayCome({"192.0.2.99"}, there));
    there.pop_back();
    EXPECT_TRUE(mayCome({"192.0.2.99", true}, there));
}

// Where all places are taken: who has most of them has one fewer.
TEST(Crowd, WhoHasMostMakesRoom) {
    const GuestOrigin one{"192.0.2.1"}, two{"192.0.2.2"}, other{"192.0.2.3"};
    const auto leaver = [](const GuestOrigin& comer, const std::vector<GuestOrigin>& there) {
        Crowd crowd(comer);
        for (const GuestOrigin& origin : there) crowd.add(origin);
        EXPECT_FALSE(crowd.hasPlace(kCrowd));
        return crowd.whoMakesRoom(kCrowd);
    };
    EXPECT_EQ(leaver(other, {two, one, two, one, one, two, one, one}), 1u) << "the first of them";
    EXPECT_EQ(leaver(one, {one, one, one}), std::nullopt) << "its own share is taken";
    std::vector<GuestOrigin> many, relayed;
    for (int n = 0; n < 8; ++n) many.push_back({"198.51.100." + std::to_string(n)});
    EXPECT_EQ(leaver(other, many), 0u);
    many[3] = other;
    EXPECT_EQ(leaver(other, many), std::nullopt) << "nobody has more";
    for (int n = 0; n < 6; ++n) relayed.push_back({"198.51.100." + std::to_string(n / 2), true});
    relayed.insert(relayed.begin(), {one, one});
    EXPECT_EQ(leaver({"192.0.2.9", true}, relayed), 2u)
        << "of those through the relay, whose places these are";
}

}  // namespace
}  // namespace bonemill::gateway
