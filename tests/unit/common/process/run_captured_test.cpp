#include "common/process/run_captured.h"

#include <gtest/gtest.h>

namespace bonemill {
namespace {

TEST(RunCaptured, TakesBothOutputsAndTheExitCode) {
    const Captured captured = runCaptured({"sh", "-c", "echo said; echo \"$0\" >&2; exit 3", "a 'word'"});
    EXPECT_EQ(captured.exit_code, 3);
    EXPECT_EQ(captured.out, "said\n");
    EXPECT_EQ(captured.err, "a 'word'\n");
}

TEST(RunCaptured, IsNotHeldUpByALotOfOutput) {
    const Captured captured =
        runCaptured({"sh", "-c", "head -c 1000000 /dev/zero >&2; head -c 1000000 /dev/zero"});
    EXPECT_EQ(captured.exit_code, 0);
    EXPECT_EQ(captured.out.size(), kMostCaptured);
    EXPECT_EQ(captured.err.size(), kMostCaptured);
}

TEST(RunCaptured, ToldFromAProgramThatIsNotThereOrWasKilled) {
    EXPECT_EQ(runCaptured({"/no/such/program"}).exit_code, 127);
    EXPECT_EQ(runCaptured({"sh", "-c", "kill -9 $$"}).exit_code, 128 + 9);
}

}  // namespace
}  // namespace bonemill
