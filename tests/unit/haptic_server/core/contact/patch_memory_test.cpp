#include <gtest/gtest.h>

#include <map>
#include <random>

#include "haptic_server/core/contact/surface_pieces.h"

namespace bonemill {
namespace {

const PatchId kPatch{.leaf = 3, .block = BlockKey::of({4, 5, 6})};

TEST(PatchMemory, KeepsWhatWasAskedForInTheLastGathering) {
    PatchMemory memory(64);
    memory.nextGathering();
    EXPECT_EQ(memory.levelOf(kPatch), PatchMemory::kNew);
    memory.levelOf(kPatch) = 3;
    memory.nextGathering();
    EXPECT_EQ(memory.levelOf(kPatch), 3);
    EXPECT_EQ(memory.levelOf({kPatch.leaf, BlockKey::of({5, 5, 6})}), PatchMemory::kNew);
    memory.nextGathering();
    memory.nextGathering();  // nobody asked for it in between
    EXPECT_EQ(memory.levelOf(kPatch), PatchMemory::kNew);
}

TEST(PatchMemory, ForgetsEverything) {
    PatchMemory memory(64);
    memory.nextGathering();
    memory.levelOf(kPatch) = 3;
    memory.forget();
    memory.nextGathering();
    EXPECT_EQ(memory.levelOf(kPatch), PatchMemory::kNew);
}

// The memory is compared with a map, with as many patches as a gathering has at most.
TEST(PatchMemory, NeverMixesPatchesUpAndHardlyForgets) {
    PatchMemory memory(4096);
    std::mt19937_64 random(5);
    std::map<PatchId, uint8_t> before, now;
    int kept = 0, lost = 0;
    for (int gathering = 0; gathering < 200; ++gathering) {
        memory.nextGathering();
        for (int n = 0; n < 600; ++n) {
            const auto patch = PatchId{LeafId(40 + random() % 4), {uint32_t(random() % 700)}};
            uint8_t& level = memory.levelOf(patch);
            const auto& asked_for = now.contains(patch) ? now : before;
            if (!asked_for.contains(patch)) {
                EXPECT_EQ(level, PatchMemory::kNew);
            } else if (level != PatchMemory::kNew) {
                EXPECT_EQ(level, asked_for.at(patch));
                ++kept;
            } else {
                ++lost;
            }
            if (level == PatchMemory::kNew) level = uint8_t(random() % 4);
            now[patch] = level;
        }
        before.swap(now);
        now.clear();
    }
    EXPECT_GT(kept, 1000);
    EXPECT_LE(lost, kept / 100);
}

TEST(PatchMemory, WhenFullEveryOtherPatchIsNew) {
    PatchMemory memory(8);
    memory.nextGathering();
    for (int n = 1; n <= 20; ++n) memory.levelOf({0, BlockKey::of({n, 0, 0})}) = 2;
    int known = 0;
    for (int n = 1; n <= 20; ++n) known += memory.levelOf({0, BlockKey::of({n, 0, 0})}) == 2;
    EXPECT_EQ(known, 8);
}

}  // namespace
}  // namespace bonemill
