#include "common/process/child_beside.h"

#include <gtest/gtest.h>
#include <signal.h>

#include "common/process/run_captured.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

int endOf(ChildBeside& child) {
    test::waitFor([&] {
        child.poll();
        return child.exitCode().has_value();
    });
    return child.exitCode().value_or(-1);
}

bool isThere(int pid) {
    return kill(pid, 0) == 0;
}

TEST(ChildBeside, WhatItPrintsIsTakenWhileItRuns) {
    ChildBeside child({"sh", "-c", "echo said; echo why >&2; cat; sleep 100"});
    EXPECT_TRUE(test::waitFor([&] {
        child.poll();
        return child.out() == "said\n" && child.err() == "why\n";
    }));
    EXPECT_FALSE(child.exitCode());
    child.askToEnd();
    EXPECT_EQ(endOf(child), 128 + SIGTERM);
}

TEST(ChildBeside, ItsEndIsToldAsAShellTellsIt) {
    ChildBeside failing({"sh", "-c", "exit 3"}), missing({"/no/such/program"}), fine({"true"});
    EXPECT_EQ(endOf(failing), 3);
    EXPECT_EQ(endOf(missing), 127);
    EXPECT_EQ(endOf(fine), 0);
}

TEST(ChildBeside, ALotOfOutputHoldsNobodyUp) {
    ChildBeside child({"sh", "-c", "head -c 1000000 /dev/zero; exit 5"});
    EXPECT_EQ(endOf(child), 5);
    EXPECT_EQ(child.out().size(), kMostCaptured);
}

TEST(ChildBeside, ItAndWhatItHasStartedEndWithUs) {
    int grandchild = 0;
    {
        ChildBeside child({"sh", "-c", "sleep 100 & echo $!; wait"});
        ASSERT_TRUE(test::waitFor([&] {
            child.poll();
            return child.out().ends_with('\n');
        }));
        grandchild = std::stoi(child.out());
        EXPECT_TRUE(isThere(grandchild));
    }
    EXPECT_TRUE(test::waitFor([&] {
        const std::string stat = test::readFile("/proc/" + std::to_string(grandchild) + "/stat");
        return stat.empty() || stat.find(") Z") != std::string::npos;
    }));
}

}  // namespace
}  // namespace bonemill
