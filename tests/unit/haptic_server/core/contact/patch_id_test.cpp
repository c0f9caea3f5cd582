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

TEST(BlockKeyBox, ContainsWhatIsInTheBox) {
    for (const IndexBox& box : {IndexBox{{2, 3, 4}, {5, 3, 6}}, IndexBox{{0, 0, 0}, {1, 1, 1}},
                                IndexBox{{kLast - 1, 0, kLast}, {kLast, 2, kLast}}}) {
        const BlockKeyBox keys(box);
        EXPECT_EQ(keys.first().index(), box.min);
        EXPECT_EQ(keys.last().index(), box.max);
        forEachIndex(box.grown(2).clamped({0, 0, 0}, {kLast, kLast, kLast}), [&](const Eigen::Vector3i& at) {
            EXPECT_EQ(keys.contains(BlockKey::of(at)), box.contains(at)) << at.transpose();
        });
        for (const Eigen::Vector3i& far :
             {Eigen::Vector3i(kLast, kLast, 0), Eigen::Vector3i(0, kLast, kLast)})
            EXPECT_EQ(keys.contains(BlockKey::of(far)), box.contains(far));
    }
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
