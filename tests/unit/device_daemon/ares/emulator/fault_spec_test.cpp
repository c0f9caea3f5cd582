#include "device_daemon/ares/emulator/fault_spec.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

TEST(FaultSpecs, AreReadWithTimesChancesAndArguments) {
    const FaultSpec drop = faultSpecOf("drop@2+0.5%12.5");
    EXPECT_EQ(drop.kind, FaultKind::kDrop);
    EXPECT_EQ(drop.start, 2);
    EXPECT_EQ(drop.duration, 0.5);
    EXPECT_EQ(drop.chance, 0.125);
    const FaultSpec delay = faultSpecOf("delay:3");
    EXPECT_DOUBLE_EQ(delay.delay, 0.003);
    EXPECT_FALSE(delay.start);
    const FaultSpec offset = faultSpecOf("encoder-offset:6:-1.5@1");
    EXPECT_EQ(offset.axis, 5);
    EXPECT_DOUBLE_EQ(offset.offset, -0.0015);
    EXPECT_TRUE(std::isinf(offset.duration));
    EXPECT_EQ(faultSpecOf("stuck-encoder:1").kind, FaultKind::kStuckEncoder);
}

TEST(FaultSpecs, AreActiveInTheirTime) {
    const FaultSpec fault = faultSpecOf("unplug@2+0.5");
    EXPECT_FALSE(fault.isActive(-1));
    EXPECT_FALSE(fault.isActive(1.99));
    EXPECT_TRUE(fault.isActive(2));
    EXPECT_FALSE(fault.isActive(2.5));
    EXPECT_TRUE(faultSpecOf("unplug").isActive(-1));
    EXPECT_FALSE(faultSpecOf("unplug@0").isActive(-1));
}

TEST(FaultSpecs, RefuseWhatMakesNoSense) {
    for (const char* text : {"", "nonsense", "drop:3", "delay", "delay:x", "delay:-1", "stuck-encoder",
                             "stuck-encoder:0", "stuck-encoder:7", "encoder-offset:1", "emergency-stop%5",
                             "drop@", "drop@1+", "drop%101", "drop%", "delay:1:2"}) {
        EXPECT_THROW(faultSpecOf(text), UserError) << text;
    }
}

TEST(FaultSpecs, AreAllExplained) {
    const std::string help = faultHelp();
    for (const char* word : {"drop", "delay:MS", "unplug", "stuck-encoder:AXIS", "encoder-offset:AXIS:MM"}) {
        EXPECT_NE(help.find(word), std::string::npos) << word;
    }
}

}  // namespace
}  // namespace bonemill
