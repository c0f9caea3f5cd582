// Leads a tick along inputs. A tick that makes no record fails the test, so that no loop over records passes
// on none.
#pragma once

#include <gtest/gtest.h>

#include "tests/support/scripted_io.h"

namespace bonemill::test {

// Tick is HapticTick or FixedTick. There is one record for each input.
template <class Tick>
std::vector<TickRecord> lead(Tick& tick, const std::vector<DeviceInput>& inputs) {
    EXPECT_FALSE(inputs.empty());
    ScriptedIo io(inputs);
    io.lead(tick);
    EXPECT_EQ(io.records.size(), inputs.size());
    return io.records;
}

}  // namespace bonemill::test
