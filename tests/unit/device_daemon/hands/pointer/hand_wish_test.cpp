// Only wishes that make sense are taken off the wire.
#include "device_daemon/hands/pointer/hand_wish.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "common/device_messages/device_messages.h"
#include "tests/support/hand_pointer.h"

namespace bonemill {
namespace {

const Pose kSomewhere{{0.1, -0.2, 0.3}, expRotation({0.4, 0.5, -0.6})};

std::optional<HandWish> parsed(const topics::HandPointer& message, uint64_t envelope_sender = 7) {
    const std::string bytes = message.SerializeAsString();
    return parseHandWish({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, envelope_sender);
}

TEST(HandWish, SaysWhatTheMessageSays) {
    const auto wish = parsed(test::handPointer(7, 3, kSomewhere, kButtonAdd | 0x100));
    ASSERT_TRUE(wish);
    EXPECT_EQ(wish->sender, 7u);
    EXPECT_EQ(wish->sequence, 3u);
    EXPECT_TRUE(wish->may_hold && wish->is_holding);
    EXPECT_EQ(wish->buttons, uint32_t{kButtonAdd}) << "unknown buttons are none";
    EXPECT_LT((wish->X_WT.position - kSomewhere.position).norm(), 1e-12);
    EXPECT_LT(wish->X_WT.rotation.angularDistance(kSomewhere.rotation), 1e-7);
    EXPECT_EQ(wish->placements, 0u);
    topics::HandPointer placed = test::handPointer(7, 4, kSomewhere);
    placed.set_placements(5);
    EXPECT_EQ(parsed(placed)->placements, 5u);
}

TEST(HandWish, LettingGoNeedsNoPose) {
    topics::HandPointer message = test::handPointer(7, 3, kSomewhere);
    message.clear_p_wt_m();
    message.set_is_holding(false);
    const auto wish = parsed(message);
    ASSERT_TRUE(wish);
    EXPECT_FALSE(wish->is_holding);
}

TEST(HandWish, AViewerWhoOnlyLooksMayNotHold) {
    topics::HandPointer message = test::handPointer(7, 3, kSomewhere);
    for (const int role : {int(topics::Viewer::VIEWER), 77}) {
        message.set_role(topics::Viewer::Role(role));
        const auto wish = parsed(message);
        ASSERT_TRUE(wish);
        EXPECT_FALSE(wish->may_hold) << role;
    }
    message.set_role(topics::Viewer::INSTRUCTOR);
    EXPECT_TRUE(parsed(message)->may_hold);
}

TEST(HandWish, RefusesWhatMakesNoSense) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    using Spoil = std::function<void(topics::HandPointer&)>;
    const Spoil spoils[] = {[](auto& m) { m.set_sender(8); },      [](auto& m) { m.set_epoch(0); },
                            [](auto& m) { m.set_sequence(0); },    [](auto& m) { m.add_p_wt_m(0); },
                            [](auto& m) { m.clear_q_wt(); },       [&](auto& m) { m.set_p_wt_m(1, nan); },
                            [](auto& m) { m.set_p_wt_m(1, 1e6); }, [](auto& m) { m.set_q_wt(0, 3); }};
    for (size_t i = 0; i < std::size(spoils); ++i) {
        topics::HandPointer message = test::handPointer(7, 3, kSomewhere);
        spoils[i](message);
        EXPECT_FALSE(parsed(message)) << i;
    }
    EXPECT_FALSE(parsed(test::handPointer(0, 3, kSomewhere), 0));
    const std::string huge(100000, 'x');
    EXPECT_FALSE(parseHandWish({reinterpret_cast<const uint8_t*>(huge.data()), huge.size()}, 7));
}

}  // namespace
}  // namespace bonemill
