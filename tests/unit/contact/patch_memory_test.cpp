#include "haptic_server/contact/patch_memory.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace bonemill {
namespace {

const PatchId kPatch{.leaf = 3, .block = BlockKey::of({4, 5, 6})};

TEST(PatchMemory, KeepsWhatWasAskedForInTheLastGathering) {
    PatchMemory memory(64);
    memory.nextGathering();
    EXPECT_EQ(memory.placesOf(kPatch), 0);
    memory.placesOf(kPatch) = 3;
    memory.nextGathering();
    EXPECT_EQ(memory.placesOf(kPatch), 3);
    EXPECT_EQ(memory.placesOf({kPatch.leaf, BlockKey::of({5, 5, 6})}), 0);
    memory.nextGathering();
    memory.nextGathering();  // nobody asked for it in between
    EXPECT_EQ(memory.placesOf(kPatch), 0);
}

TEST(PatchMemory, ForgetsEverything) {
    PatchMemory memory(64);
    memory.nextGathering();
    memory.placesOf(kPatch) = 3;
    memory.forget();
    memory.nextGathering();
    EXPECT_EQ(memory.placesOf(kPatch), 0);
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
            uint8_t& places = memory.placesOf(patch);
            const auto& asked_for = now.contains(patch) ? now : before;
            if (!asked_for.contains(patch)) {
                EXPECT_EQ(places, 0);
            } else if (places != 0) {
                EXPECT_EQ(places, asked_for.at(patch));
                ++kept;
            } else {
                ++lost;
            }
            if (places == 0) places = uint8_t(1 + random() % 4);
            now[patch] = places;
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
    for (int n = 1; n <= 20; ++n) memory.placesOf({0, BlockKey::of({n, 0, 0})}) = 2;
    int known = 0;
    for (int n = 1; n <= 20; ++n) known += memory.placesOf({0, BlockKey::of({n, 0, 0})}) == 2;
    EXPECT_EQ(known, 8);
}

}  // namespace
}  // namespace bonemill
