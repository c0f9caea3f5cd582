#include "render_client/link/subscribe/density_payloads.h"

#include "common/bounds/message_bounds.h"

namespace bonemill {
namespace {

constexpr int64_t kMaxBricks = 1 << 20;  // of a server's 16³ voxels, a scan of 1600³

int64_t bricksOf(const topics::DensityGrid& grid) {
    int64_t bricks = 1;
    for (const uint32_t voxels : grid.voxels())
        bricks *= (int64_t(voxels) + grid.brick_edge() - 1) / grid.brick_edge();
    return bricks;
}

}  // namespace

bool isUsableGrid(const topics::DensityGrid& grid) {
    if (!isWithinBounds(grid)) return false;
    const int64_t bricks = bricksOf(grid);
    return bricks <= kMaxBricks && int64_t(grid.air().size()) == (bricks + 7) / 8 &&
           grid.value_at_0() < grid.value_at_65535();
}

DensityGrid densityGridOf(const topics::DensityGrid& grid) {
    const auto& n = grid.voxels();
    return {.voxels = {int(n[0]), int(n[1]), int(n[2])},
            .spacing_m = Eigen::Map<const Eigen::Vector3d>(grid.spacing_m().data()),
            .origin_m = Eigen::Map<const Eigen::Vector3d>(grid.origin_m().data()),
            .brick_edge = int(grid.brick_edge()),
            .value_at_0 = grid.value_at_0(),
            .value_at_65535 = grid.value_at_65535(),
            .iso_value = grid.iso_value()};
}

std::optional<topics::DensityBrick> parseDensityBrick(std::span<const uint8_t> payload) {
    topics::DensityBrick brick;
    if (!parseWithinBounds(payload, brick)) return std::nullopt;
    return brick;
}

}  // namespace bonemill
