// Random and mutated bytes go through the decoder of densities: nothing crashes (nor makes a sanitizer
// speak), and what is accepted is a whole brick.
#include <gtest/gtest.h>

#include "common/density_codec/density_codec.h"
#include "tests/support/ct_brick.h"
#include "tests/support/mutated_bytes.h"

namespace bonemill {
namespace {

constexpr int kRounds = 20000, kEdge = 8;

TEST(DensityCodecFuzz, TakesAnyBytes) {
    std::mt19937 random(2026);
    DensityEncoder encoder(test::kCtWindow);
    DensityDecoder decoder;
    const std::vector<uint16_t> scanned = test::ctBrick(kEdge, random);
    const std::string whole = encoder.scanned(scanned, kEdge);
    const std::string change = encoder.change(scanned, test::milledBrick(scanned, random));
    const std::string materials = encoder.materials(std::vector<uint8_t>(scanned.begin(), scanned.end()));
    int refused = 0;
    for (int round = 0; round < kRounds; ++round) {
        const auto brick = decoder.scanned(test::mutated(whole, random), kEdge);
        const auto present = decoder.present(test::mutated(change, random), scanned);
        EXPECT_TRUE(!brick || brick->size() == scanned.size());
        EXPECT_TRUE(!present || present->size() == scanned.size());
        const auto made_of = decoder.materials(test::mutated(materials, random), scanned.size());
        EXPECT_TRUE(!made_of || made_of->empty() || made_of->size() == scanned.size());
        refused += !brick + !present + !made_of;
    }
    EXPECT_GT(refused, kRounds / 4);
    EXPECT_EQ(decoder.scanned(whole, kEdge), scanned) << "damage before it leaves no trace";
}

}  // namespace
}  // namespace bonemill
