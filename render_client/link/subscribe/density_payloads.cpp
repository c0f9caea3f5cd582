#include "render_client/link/subscribe/density_payloads.h"

#include <google/protobuf/stubs/logging.h>

#include <algorithm>
#include <cmath>

#include "common/density_codec/density_codec.h"

namespace bonemill {
namespace {

constexpr uint32_t kMostVoxelsPerAxis = 16384;
constexpr int64_t kMostBricks = 1 << 20;  // of a server's 16³ voxels, a scan of 1600³
constexpr uint32_t kLeastBrickEdge = 8;
constexpr double kMostSpacing_m = 1;
constexpr double kFurthestOrigin_m = 1e3;
constexpr double kLargestValue = 1e6;
constexpr size_t kLongestBrick = 2u << 20;  // bytes, many times what a brick needs

bool isBetween(double value, double low, double high) {
    return value >= low && value <= high;  // not for NaN
}

int64_t bricksOf(const topics::DensityGrid& grid) {
    int64_t bricks = 1;
    for (const uint32_t voxels : grid.voxels())
        bricks *= (int64_t(voxels) + grid.brick_edge() - 1) / grid.brick_edge();
    return bricks;
}

}  // namespace

bool isUsableGrid(const topics::DensityGrid& grid) {
    const auto is_count = [](uint32_t voxels) { return voxels >= 1 && voxels <= kMostVoxelsPerAxis; };
    const auto is_spacing = [](double metres) { return metres > 0 && metres <= kMostSpacing_m; };
    const auto is_place = [](double m) { return isBetween(m, -kFurthestOrigin_m, kFurthestOrigin_m); };
    const auto is_value = [](double value) { return isBetween(value, -kLargestValue, kLargestValue); };
    if (grid.voxels_size() != 3 || grid.spacing_m_size() != 3 || grid.origin_m_size() != 3 ||
        grid.brick_edge() < kLeastBrickEdge || grid.brick_edge() > uint32_t(kMostBrickEdge) ||
        !std::ranges::all_of(grid.voxels(), is_count) || !std::ranges::all_of(grid.spacing_m(), is_spacing) ||
        !std::ranges::all_of(grid.origin_m(), is_place))
        return false;
    const int64_t bricks = bricksOf(grid);
    return bricks <= kMostBricks && int64_t(grid.air().size()) == (bricks + 7) / 8 &&
           is_value(grid.value_at_0()) && is_value(grid.value_at_65535()) && is_value(grid.iso_value()) &&
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
    const google::protobuf::LogSilencer silencer;
    topics::DensityBrick brick;
    if (payload.size() > kLongestBrick ||
        !brick.ParseFromArray(payload.data(), static_cast<int>(payload.size())) || brick.epoch() == 0)
        return {};
    return brick;
}

}  // namespace bonemill
