// Keys and axes of an input device are kept from its events, and asked for anew when events were dropped.
#include <gtest/gtest.h>

#include "device_daemon/hands/input/evdev_device.h"
#include "tests/unit/device_daemon/hands/input/input_test_tools.h"

namespace bonemill {
namespace {

using test::bytesOf;
using test::inputEvent;

TEST(EvdevStream, KeepsWhatIsHeldAndWhereAxesStand) {
    EvdevStream stream(test::padState());
    stream.take(bytesOf(inputEvent(EV_KEY, BTN_SOUTH, 1)));
    stream.take(bytesOf(inputEvent(EV_ABS, ABS_X, 16000)));
    stream.take(bytesOf(inputEvent(EV_SYN, SYN_REPORT, 0)));
    EXPECT_TRUE(stream.state().keys[BTN_SOUTH]);
    EXPECT_EQ(stream.state().axes[ABS_X].value, 16000);
    stream.take(bytesOf(inputEvent(EV_KEY, BTN_SOUTH, 2)));
    EXPECT_TRUE(stream.state().keys[BTN_SOUTH]);
    stream.take(bytesOf(inputEvent(EV_KEY, BTN_SOUTH, 0)));
    EXPECT_FALSE(stream.state().keys[BTN_SOUTH]);
}

TEST(EvdevStream, WaitsForTheRestOfATruncatedEvent) {
    EvdevStream stream;
    const input_event press = inputEvent(EV_KEY, KEY_B, 1);
    stream.take(bytesOf(press).first(7));
    EXPECT_FALSE(stream.state().keys[KEY_B]);
    stream.take(bytesOf(press).subspan(7));
    EXPECT_TRUE(stream.state().keys[KEY_B]);
}

TEST(EvdevStream, AfterDroppedEventsNothingIsBelievedUntilRefreshed) {
    EvdevStream stream;
    stream.take(bytesOf(inputEvent(EV_SYN, SYN_DROPPED, 0)));
    stream.take(bytesOf(inputEvent(EV_KEY, KEY_B, 1)));
    EXPECT_FALSE(stream.state().keys[KEY_B]);
    EXPECT_FALSE(stream.needsRefresh());
    stream.take(bytesOf(inputEvent(EV_SYN, SYN_REPORT, 0)));
    EXPECT_TRUE(stream.needsRefresh());
    EvdevState state;
    state.keys.set(KEY_A);
    stream.refresh(state);
    EXPECT_FALSE(stream.needsRefresh());
    EXPECT_TRUE(stream.state().keys[KEY_A]);
    stream.take(bytesOf(inputEvent(EV_KEY, KEY_B, 1)));
    EXPECT_TRUE(stream.state().keys[KEY_B]);
}

TEST(EvdevAxis, IsAShareBetweenItsEnds) {
    EXPECT_EQ((EvdevAxis{.value = 0, .min = -100, .max = 100}.fromCentre()), 0);
    EXPECT_EQ((EvdevAxis{.value = 100, .min = -100, .max = 100}.fromCentre()), 1);
    EXPECT_EQ((EvdevAxis{.value = 0, .min = 0, .max = 255}.fromCentre()), -1);
    EXPECT_EQ((EvdevAxis{.value = 0, .min = 0, .max = 255}.fromEnd()), 0);
    EXPECT_EQ((EvdevAxis{.value = 255, .min = 0, .max = 255}.fromEnd()), 1);
    EXPECT_EQ((EvdevAxis{.value = 5000, .min = 0, .max = 255}.fromCentre()), 1);
    EXPECT_EQ((EvdevAxis{.value = INT32_MIN, .min = INT32_MIN, .max = INT32_MAX}.fromCentre()), -1);
}

TEST(EvdevAxis, WithoutARangeItIsNotThere) {
    for (const EvdevAxis& axis : {EvdevAxis{}, EvdevAxis{.value = 7, .min = 5, .max = 5},
                                  EvdevAxis{.value = 7, .min = 5, .max = -5}}) {
        EXPECT_FALSE(axis.exists());
        EXPECT_EQ(axis.fromCentre(), 0);
        EXPECT_EQ(axis.fromEnd(), 0);
    }
}

}  // namespace
}  // namespace bonemill
