#include "haptic_server/core/telemetry/fault_names.h"

#include <gtest/gtest.h>

#include <set>

#include "haptic_server/core/telemetry/tick_record.h"

namespace bonemill {
namespace {

TEST(FaultNames, everyBitHasItsOwnName) {
    std::set<std::string> names;
    for (int bit = 0; bit < 32; ++bit) names.insert(faultNames(1u << bit));
    EXPECT_EQ(names.size(), 32u);
    EXPECT_EQ(names.count("none"), 0u);
}

TEST(FaultNames, everyDefinedFaultIsKnown) {
    for (uint32_t fault = kFaultOverrun; fault <= kLastFault; fault <<= 1) {
        EXPECT_EQ(faultNames(fault).find("unknown"), std::string::npos) << fault;
    }
    EXPECT_NE(faultNames(kLastFault << 1).find("unknown"), std::string::npos) << "kLastFault is not the last";
    EXPECT_EQ(faultNames(1u << 31), "unknown_bit_31");
}

TEST(FaultNames, listsFromTheLowestBit) {
    EXPECT_EQ(faultNames(kFaultNone), "none");
    EXPECT_TRUE(faultList(kFaultNone).empty());
    EXPECT_EQ(faultNames(kFaultForceClamped | kFaultOverrun | kFaultStaleDevice),
              "overrun, stale_device, force_clamped");
}

}  // namespace
}  // namespace bonemill
