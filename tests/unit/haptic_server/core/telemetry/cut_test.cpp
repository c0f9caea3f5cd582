#include "haptic_server/core/telemetry/cut.h"

#include <gtest/gtest.h>

namespace bonemill {
namespace {

TEST(Cut, HoldsTheBoxThatItWasMadeOf) {
    const Cut cut = cutOf({{-1, 2, 3}, {4, 5, 600}}, 7);
    EXPECT_EQ(cut.start_ns, 7);
    EXPECT_EQ(cut.voxels().min, Eigen::Vector3i(-1, 2, 3));
    EXPECT_EQ(cut.voxels().max, Eigen::Vector3i(4, 5, 600));
    EXPECT_FALSE(cut.isEmpty());
}

TEST(Cut, IsEmptyWhereTheBoxIs) {
    EXPECT_TRUE(Cut{}.isEmpty());
    EXPECT_TRUE(cutOf({}, 7).isEmpty());
    for (int axis = 0; axis < 3; ++axis) {
        IndexBox box{Eigen::Vector3i::Zero(), Eigen::Vector3i::Ones()};
        box.max[axis] = -1;
        EXPECT_TRUE(cutOf(box, 7).isEmpty()) << axis;
    }
}

TEST(Cut, TheMesherIsToldOfCutsAndOfNothingElse) {
    SpscRing<Cut> cuts(4);
    tellMesher(cuts, {});
    tellMesher(cuts, cutOf({{1, 2, 3}, {4, 5, 6}}, 5));
    Cut cut;
    ASSERT_TRUE(cuts.tryPop(cut));
    EXPECT_EQ(cut.start_ns, 5);
    EXPECT_EQ(cut.voxels().max, Eigen::Vector3i(4, 5, 6));
    EXPECT_FALSE(cuts.tryPop(cut));
}

}  // namespace
}  // namespace bonemill
