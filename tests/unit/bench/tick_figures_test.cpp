#include "tests/bench/tick_figures.h"

#include <gtest/gtest.h>

namespace bonemill {
namespace {

using bench::figuresOf;
using bench::TickFigures;

TickRecord tickWith(uint32_t contacts, uint32_t candidates) {
    TickRecord record{};
    record.contacts = contacts;
    record.candidates = candidates;
    record.iterations = 2;
    return record;
}

TEST(TickFigures, CandidatesCountInEveryTickContactsInThoseThatHaveSome) {
    const TickFigures figures =
        figuresOf({tickWith(900, 9000), tickWith(0, 100), tickWith(10, 200), tickWith(0, 300)}, 1);
    EXPECT_DOUBLE_EQ(figures.candidates_mean, 200);
    EXPECT_DOUBLE_EQ(figures.contacts_mean, 10);
    EXPECT_DOUBLE_EQ(figures.iterations_mean, 2);
}

TEST(TickFigures, WithoutTicksAfterTheApproachTheMeansAreZero) {
    for (const TickFigures& figures : {figuresOf({}, 1), figuresOf({tickWith(1, 1)}, 1)}) {
        EXPECT_EQ(figures.candidates_mean, 0);
        EXPECT_EQ(figures.contacts_mean, 0);
        EXPECT_EQ(figures.iterations_mean, 0);
        EXPECT_EQ(figures.removed_voxels_per_tick, 0);
    }
}

}  // namespace
}  // namespace bonemill
