// What is remembered of a cell is that cell's alone.
#include "haptic_server/core/milling/cell_memory.h"

#include <gtest/gtest.h>

namespace bonemill {
namespace {

using Eigen::Vector3i;

TEST(CellMemory, KnowsACellUntilAnotherHasItsPlace) {
    CellMemory<int> memory;
    EXPECT_EQ(memory.find({0, 0, 0}), nullptr);
    constexpr int kEdge = CellMemory<int>::kEdge;
    const Vector3i first(-1, 5, 31), other(kEdge - 1, 5, 31), same_place(kEdge - 1, 5 + kEdge, 31 - kEdge);
    memory.remember(first, 1);
    ASSERT_NE(memory.find(first), nullptr);
    EXPECT_EQ(*memory.find(first), 1);
    for (const Vector3i& cell :
         {other, same_place, Vector3i(0, 5, 31), Vector3i(-1, 6, 31), Vector3i(-1, 5, 32)})
        EXPECT_EQ(memory.find(cell), nullptr) << cell.transpose();
    memory.remember(other, 2);
    EXPECT_EQ(memory.find(first), nullptr);
    EXPECT_EQ(*memory.find(other), 2);
}

TEST(CellMemory, ForgetsAllAtOnce) {
    CellMemory<int> memory;
    memory.remember({1, 2, 3}, 1);
    memory.forgetAll();
    EXPECT_EQ(memory.find({1, 2, 3}), nullptr);
    memory.remember({1, 2, 3}, 2);
    EXPECT_EQ(*memory.find({1, 2, 3}), 2);
}

}  // namespace
}  // namespace bonemill
