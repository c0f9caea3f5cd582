#include "haptic_server/core/contact/patch_id.h"

#include <gtest/gtest.h>

namespace bonemill {
namespace {

constexpr int kLast = BlockKey::kMaxPerAxis - 1;

TEST(BlockKey, GivesBackTheIndexThatItWasMadeOf) {
    for (const Eigen::Vector3i& index :
         {Eigen::Vector3i(0, 0, 0), Eigen::Vector3i(1, 2, 3), Eigen::Vector3i(kLast, 0, 0),
          Eigen::Vector3i(0, kLast, 0), Eigen::Vector3i(0, 0, kLast), Eigen::Vector3i(kLast, kLast, kLast)})
        EXPECT_EQ(BlockKey::of(index).index(), index);
}

TEST(BlockKey, OrdersBlocksWithXFastest) {
    EXPECT_LT(BlockKey::of({kLast, 0, 0}), BlockKey::of({0, 1, 0}));
    EXPECT_LT(BlockKey::of({kLast, kLast, 0}), BlockKey::of({0, 0, 1}));
    EXPECT_LT(BlockKey::of({1, 2, 3}), BlockKey::of({2, 2, 3}));
}

TEST(PatchId, IsPackedWithoutLoss) {
    const PatchId last{.leaf = ~LeafId(0), .block = BlockKey::of({kLast, kLast, kLast})};
    EXPECT_NE(last.packed(), (PatchId{last.leaf - 1, last.block}.packed()));
    EXPECT_NE(last.packed(), (PatchId{last.leaf, BlockKey::of({kLast - 1, kLast, kLast})}.packed()));
    EXPECT_LT(last.packed(), uint64_t(last.leaf) << 32 | ~uint32_t(0));
    EXPECT_EQ((PatchId{7, BlockKey::of({1, 0, 0})}.packed()), uint64_t(7) << 32 | 1);
}

}  // namespace
}  // namespace bonemill
