// A million damaged frames come from guests: what is believed has numbers to compute with, and survives being
// said again.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "render_client/web/gateway/guest_voice.h"
#include "tests/support/mutated_bytes.h"

namespace bonemill::gateway {
namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr int kFrames = 100'000;
#else
constexpr int kFrames = 1'000'000;
#endif

std::vector<std::string> genuineFrames() {
    std::vector<FromGuest> messages(6);
    Hello& hello = *messages[0].mutable_hello();
    hello.set_token("0123456789abcdef0123456789abcdef");
    for (uint32_t leaf = 0; leaf < 20; ++leaf) {
        hello.add_leaves(leaf * 1000);
        hello.add_revisions(leaf);
    }
    messages[1].mutable_command()->set_sequence(1);
    messages[1].mutable_command()->set_start_attempt("Anna");
    topics::Viewer& viewer = *messages[2].mutable_announce();
    viewer.set_frame_rate_hz(60);
    viewer.mutable_camera()->set_has_target(true);
    topics::HandPointer& hand = *messages[3].mutable_hand();
    hand.set_is_holding(true);
    for (const double value : {0.1, 0.2, 0.3}) {
        viewer.add_pointer_m(value);
        viewer.mutable_camera()->add_target_m(value);
        hand.add_p_wt_m(value);
    }
    for (const double value : {1.0, 0.0, 0.0, 0.0}) hand.add_q_wt(value);
    messages[4].mutable_received()->set_bytes(123456);
    for (const uint32_t number : {3, 1, 2, 5}) {
        messages[5].mutable_wish()->add_lacking(number);
        messages[5].mutable_wish()->add_held(number);
    }
    std::vector<std::string> frames;
    for (const FromGuest& message : messages) frames.push_back(message.SerializeAsString());
    return frames;
}

bool isComputable(const FromGuest& message) {
    for (const double value : message.hand().p_wt_m())
        if (message.hand().is_holding() && !std::isfinite(value)) return false;
    for (const double value : message.announce().pointer_m())
        if (!std::isfinite(value)) return false;
    return std::isfinite(message.announce().frame_rate_hz()) &&
           std::isfinite(message.announce().camera().distance_m());
}

TEST(GuestFramesFuzz, OnlyWhatMakesSenseIsBelieved) {
    const std::vector<std::string> genuine = genuineFrames();
    std::mt19937 random(5);
    int believed = 0;
    for (const std::string& frame : genuine) ASSERT_TRUE(parseFromGuest(frame));
    for (int n = 0; n < kFrames; ++n) {
        const std::string frame = test::mutated(genuine[size_t(n) % genuine.size()], random);
        const auto message = parseFromGuest(frame);
        if (!message) continue;
        ++believed;
        ASSERT_TRUE(isComputable(*message));
        ASSERT_TRUE(n % 64 != 0 || parseFromGuest(message->SerializeAsString()));
    }
    EXPECT_GT(believed, kFrames / 50);
    EXPECT_LT(believed, kFrames);
}

}  // namespace
}  // namespace bonemill::gateway
