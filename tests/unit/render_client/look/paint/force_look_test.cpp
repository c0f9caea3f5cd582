#include <gtest/gtest.h>

#include "render_client/look/paint/marker_painter.h"

namespace bonemill {
namespace {

TEST(ForceLook, TheArrowGrowsAndTurnsFromGreenToRed) {
    EXPECT_EQ(forceLook(0.049).length, 0);
    double last = 0;
    for (const double force : {0.05, 0.2, 1.0, 5.0, 20.0}) {
        EXPECT_GT(forceLook(force).length, last);
        last = forceLook(force).length;
    }
    EXPECT_EQ(forceLook(100).length, last) << "never out of the picture";
    EXPECT_GT(forceLook(0.2).colour.y(), 2 * forceLook(0.2).colour.x());
    EXPECT_GT(forceLook(20).colour.x(), 2 * forceLook(20).colour.y());
}

}  // namespace
}  // namespace bonemill
