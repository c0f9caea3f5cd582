#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/commands/role_rules.h"

namespace bonemill {
namespace {

using topics::Command;

int takenOf(OrderLimits& limits, CommandAction action, int64_t now_ns) {
    int taken = 0;
    while (taken < 1000 && limits.whyNotNow(action, now_ns).empty()) ++taken;
    return taken;
}

TEST(OrderLimits, EachLimitIsItsRows) {
    OrderLimits limits;
    constexpr int64_t kStart = 1000 * kNsPerSecond;
    forEachCommand([&](CommandAction action, const topics::CommandRow& row) {
        if (!row.has_limit()) return;
        const int at_once = row.limit().at_once();
        EXPECT_EQ(takenOf(limits, action, kStart), at_once) << fieldOf(action)->name();
        EXPECT_EQ(takenOf(limits, action, kStart + row.limit().every_s() * kNsPerSecond), 1);
    });
}

TEST(OrderLimits, OrdersThatCostTheSameShareALimit) {
    OrderLimits limits;
    constexpr int64_t kStart = 1000 * kNsPerSecond;
    EXPECT_EQ(takenOf(limits, Command::kRestoreCheckpoint, kStart), 8);
    EXPECT_EQ(limits.whyNotNow(Command::kResetVolume, kStart),
              "that was too often: it works once in 1 s; wait, then try again");
    EXPECT_EQ(takenOf(limits, Command::kPauseMilling, kStart), 1000) << "it costs nothing";
}

}  // namespace
}  // namespace bonemill
