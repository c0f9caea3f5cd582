// Follows what a scene's effects tell, from the publisher to a viewer that draws seldom.
#include <gtest/gtest.h>

#include <thread>

#include "haptic_server/server/publish/publisher.h"
#include "tests/integration/dds/client_probe.h"
#include "tests/support/synthetic_nodes.h"

namespace bonemill {
namespace {

class EffectStateTest : public testing::Test {
  protected:
    // The first state that arrives says that the two have found each other.
    void meet() {
        ASSERT_TRUE(client_.pollUntil([&] {
            publisher_.publishToolState(syntheticTick(++tick_));
            return client_.subscriber.toolState().has_value();
        }));
    }
    void publish(uint32_t events, double removed_mm3) {
        topics::EffectState state;
        state.set_events(events);
        state.set_removed_mm3(removed_mm3);
        state.set_temperature_c(30 + double(tick_ % 7));
        last_temperature_ = state.temperature_c();
        publisher_.publishToolState(syntheticTick(++tick_), state);
    }

    Publisher publisher_{{.domain = testDomain(), .session = testSession()}};
    ClientProbe client_;
    uint64_t tick_ = 0;
    double last_temperature_ = 0;
};

TEST_F(EffectStateTest, WithoutEffectsTheToolStateIsWhatItWas) {
    meet();
    topics::ToolState state = *client_.subscriber.toolState();
    EXPECT_FALSE(state.has_effects());
    const std::string bytes = state.SerializeAsString();
    for (int field : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 14, 15})
        state.GetReflection()->ClearField(&state, state.GetDescriptor()->FindFieldByNumber(field));
    EXPECT_EQ(state.ByteSizeLong(), 0u) << "no bytes but those of the fields that were always there";
    EXPECT_GT(bytes.size(), 100u);
}

// A viewer at 20 pictures per second gets five states per picture: no event and no volume of them is lost.
TEST_F(EffectStateTest, WhatHappenedBetweenTwoPicturesAddsUp) {
    meet();
    publish(topics::EffectState::PROTECTED_TOUCHED, 0.25);
    publish(0, 0.5);
    publish(topics::EffectState::SPINDLE_STALLED, 0.125);
    publish(0, 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));  // mostly they all come in one poll
    double removed = 0;
    uint32_t events = 0;
    uint64_t seen = client_.subscriber.toolState()->tick();
    ASSERT_TRUE(client_.pollUntil([&] {
        const topics::ToolState& state = *client_.subscriber.toolState();
        if (state.tick() != seen) {
            seen = state.tick();
            removed += state.effects().removed_mm3();
            events |= state.effects().events();
        }
        return seen == tick_;
    }));
    EXPECT_EQ(removed, 0.875);
    EXPECT_EQ(events, topics::EffectState::PROTECTED_TOUCHED | topics::EffectState::SPINDLE_STALLED);
    EXPECT_EQ(client_.subscriber.toolState()->effects().temperature_c(), last_temperature_)
        << "of the newest";
}

}  // namespace
}  // namespace bonemill
