// Random and mutated bytes go through the parsers of what is said about densities, as in topics_fuzz.cpp.
#include <gtest/gtest.h>

#include "haptic_server/surface/density_stream/density_stream.h"
#include "render_client/link/subscribe/payloads.h"
#include "tests/support/mutated_bytes.h"

namespace bonemill {
namespace {

constexpr int kDensityRounds = 20000;

template <class Accepts>
void fuzzDensities(const std::string& valid, Accepts&& accepts) {
    std::mt19937 random(16);
    int accepted = 0;
    for (int round = 0; round < kDensityRounds; ++round) {
        const std::string bytes = test::mutated(valid, random);
        accepted += accepts(std::span(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()));
    }
    EXPECT_TRUE(accepts(std::span(reinterpret_cast<const uint8_t*>(valid.data()), valid.size())));
    EXPECT_LT(accepted, kDensityRounds);
}

TEST(DensitiesFuzz, Wish) {
    topics::DensityWish wish;
    wish.set_epoch(300);
    wish.set_sender(5);
    for (uint32_t n = 0; n < 40; ++n) wish.add_lacking(n * 20);
    for (uint32_t n = 0; n < 30; ++n) wish.add_held(1 + n % 7);
    wish.add_revisions(1);
    wish.add_revisions(17);
    fuzzDensities(wish.SerializeAsString(), [](std::span<const uint8_t> bytes) {
        const auto bricks = parseDensityWish(bytes, 5, 300, 1000);
        if (!bricks) return false;
        for (const WishedBrick& brick : *bricks) EXPECT_LT(brick.brick, 1000u);
        EXPECT_LE(bricks->size(), 16384u);
        return true;
    });
}

TEST(DensitiesFuzz, Brick) {
    topics::DensityBrick brick;
    brick.set_epoch(300);
    brick.set_revision(8);
    brick.set_scanned(std::string(100, 'a'));
    brick.set_change(std::string(10, 'b'));
    fuzzDensities(brick.SerializeAsString(), [](std::span<const uint8_t> bytes) {
        const auto parsed = parseDensityBrick(bytes);
        return parsed && parsed->epoch() == 300 && parsed->scanned().size() == 100;
    });
}

TEST(DensitiesFuzz, Grid) {
    topics::DensityGrid grid;
    for (const uint32_t n : {100, 80, 33}) grid.add_voxels(n);
    for (int axis = 0; axis < 3; ++axis) {
        grid.add_spacing_m(0.5e-3);
        grid.add_origin_m(0.01);
    }
    grid.set_brick_edge(16);
    grid.set_value_at_0(-200);
    grid.set_value_at_65535(1800);
    grid.set_air(std::string((7 * 5 * 3 + 7) / 8, 'x'));
    fuzzDensities(grid.SerializeAsString(), [](std::span<const uint8_t> bytes) {
        topics::DensityGrid parsed;
        if (!parsed.ParseFromArray(bytes.data(), int(bytes.size())) || !isUsableGrid(parsed)) return false;
        const DensityGrid usable = densityGridOf(parsed);
        EXPECT_TRUE((usable.voxels.array() >= 1).all() && usable.spacing_m.allFinite());
        EXPECT_TRUE((usable.spacing_m.array() > 0).all() && usable.origin_m.allFinite());
        EXPECT_GE(parsed.air().size() * 8, size_t(brickCount(usable)));
        return true;
    });
}

}  // namespace
}  // namespace bonemill
