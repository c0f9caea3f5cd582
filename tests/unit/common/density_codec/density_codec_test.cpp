#include "common/density_codec/density_codec.h"

#include <gtest/gtest.h>

#include "tests/support/ct_brick.h"

namespace bonemill {
namespace {

using Densities = std::vector<uint16_t>;

constexpr int kEdge = 16;
constexpr size_t kVoxels = 16 * 16 * 16;

TEST(DensityCodec, GivesRandomBricksBackExactly) {
    std::mt19937 random(16);
    DensityDecoder decoder;
    for (int round = 0; round < 300; ++round) {
        const int edge = 1 + int(random() % 20);
        Densities scanned = test::ctBrick(edge, random);
        if (round % 3 == 1)
            for (uint16_t& density : scanned) density = uint16_t(random());
        if (round % 3 == 2)
            for (uint32_t odd = random() % 3; odd > 0; --odd)
                scanned[random() % scanned.size()] ^= uint16_t(1 + random() % 30);
        DensityEncoder encoder(round % 2 == 0 ? test::kCtWindow : uint16_t(1 + random() % 65535));
        EXPECT_EQ(decoder.scanned(encoder.scanned(scanned, edge), edge), scanned);
        const Densities present = test::milledBrick(scanned, random);
        EXPECT_EQ(decoder.present(encoder.change(scanned, present), scanned), present);
    }
}

// Any ladder comes back, whatever the machine makes of its roundings.
TEST(DensityCodec, StandsOnEveryLadder) {
    DensityDecoder decoder;
    for (const int steps : {1, 2, 3, 255, 1000, 2000, 4095, 4096, 10000, 65534, 65535}) {
        DensityEncoder encoder{uint16_t(steps)};
        Densities scanned(kVoxels);
        for (size_t n = 0; n < kVoxels; ++n)
            scanned[n] = uint16_t(std::lround(double(n % size_t(steps + 1)) / steps * 65535));
        const std::string bytes = encoder.scanned(scanned, kEdge);
        EXPECT_EQ(decoder.scanned(bytes, kEdge), scanned) << steps;
        EXPECT_EQ(uint8_t(bytes[1]) + 256 * uint8_t(bytes[2]), steps)
            << "it is on the ladder, ends of it included";
    }
}

TEST(DensityCodec, SpendsLittleOnWhatIsPlain) {
    std::mt19937 random(7);
    DensityEncoder encoder(test::kCtWindow), without_ladder(65535);
    EXPECT_EQ(encoder.scanned(Densities(kVoxels, 0), kEdge).size(), 3u) << "air";
    EXPECT_EQ(encoder.scanned(Densities(kVoxels, 65535), kEdge).size(), 3u) << "the densest bone";
    const Densities scanned = test::ctBrick(kEdge, random);
    const size_t size = encoder.scanned(scanned, kEdge).size();
    EXPECT_LT(size, kVoxels) << "noise of 12 HU takes 5.6 bits";
    EXPECT_LT(size, without_ladder.scanned(scanned, kEdge).size() * 3 / 4);
    Densities with_pieces = scanned;  // that the import removed
    for (size_t n = 1000; n < 1500; ++n) with_pieces[n] = 9999;
    EXPECT_LT(encoder.scanned(with_pieces, kEdge).size(), size + 100);
    EXPECT_TRUE(encoder.change(scanned, scanned).empty());
    Densities present = scanned;
    std::fill_n(present.begin(), kVoxels / 2, uint16_t(0));
    present[kVoxels / 2] = 77;
    EXPECT_LT(encoder.change(scanned, present).size(), 40u);
}

TEST(DensityCodec, GivesMaterialsBack) {
    std::mt19937 random(5);
    DensityEncoder encoder(test::kCtWindow);
    DensityDecoder decoder;
    std::vector<uint8_t> materials(kVoxels);
    EXPECT_TRUE(encoder.materials(materials).empty()) << "none";
    EXPECT_TRUE(encoder.materials({}).empty()) << "nobody asks";
    EXPECT_EQ(decoder.materials("", kVoxels), std::vector<uint8_t>());
    for (uint8_t& material : materials) material = uint8_t(random());
    const std::string bytes = encoder.materials(materials);
    EXPECT_EQ(decoder.materials(bytes, kVoxels), materials);
    EXPECT_FALSE(decoder.materials(bytes, kVoxels - 1));
    EXPECT_FALSE(decoder.materials(bytes, kVoxels + 1));
    EXPECT_FALSE(decoder.materials(bytes.substr(1), kVoxels));
    for (size_t n = 0; n < kVoxels; ++n) materials[n] = n % 256 < 100 ? 4 : 3;
    EXPECT_LT(encoder.materials(materials).size(), 150u) << "layers cost little";
}

TEST(DensityCodec, RefusesWhatIsNoBrick) {
    std::mt19937 random(7);
    DensityEncoder encoder(test::kCtWindow);
    DensityDecoder decoder;
    const Densities scanned = test::ctBrick(kEdge, random);
    const std::string bytes = encoder.scanned(scanned, kEdge);
    EXPECT_FALSE(decoder.scanned(bytes, kEdge - 1));
    EXPECT_FALSE(decoder.scanned(bytes, kEdge + 1));
    EXPECT_FALSE(decoder.scanned(bytes, 0));
    EXPECT_FALSE(decoder.scanned(bytes, kMaxBrickEdge + 1));
    EXPECT_FALSE(decoder.scanned("", kEdge));
    EXPECT_FALSE(decoder.scanned(bytes.substr(0, bytes.size() - 1), kEdge));
    std::string shorter_ladder = bytes;
    shorter_ladder[1] = 100;
    shorter_ladder[2] = 0;
    EXPECT_FALSE(decoder.scanned(shorter_ladder, kEdge)) << "steps beyond the ladder's end";
    const std::string change = encoder.change(scanned, Densities(kVoxels, 5));
    EXPECT_TRUE(decoder.present(change, scanned));
    EXPECT_FALSE(decoder.present(change, std::span(scanned).first(100)));
    EXPECT_FALSE(decoder.present(bytes, scanned));
}

}  // namespace
}  // namespace bonemill
