#include "render_client/look/slices/slice_image.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace bonemill {
namespace {

constexpr double kMostDensity = 65535;
constexpr double kNarrowest = 1.0 / 200;  // of the scan's range
constexpr double kSofterShare = 0.5;      // of the range above the surface

double rangeOf(const DensityGrid& grid) {
    return grid.value_at_65535 - grid.value_at_0;
}

constexpr uint16_t kFull = 65535;
constexpr double kOnVoxel = 1e-6;  // voxels: so near to a voxel its neighbour does not count

}  // namespace

double valueOf(const DensityGrid& grid, double density) {
    return grid.value_at_0 + density / kMostDensity * rangeOf(grid);
}

double densityOf(const DensityGrid& grid, double value) {
    return (value - grid.value_at_0) / rangeOf(grid) * kMostDensity;
}

double greyOf(const GreyWindow& window, double value) {
    return std::clamp((value - window.level) / window.width + 0.5, 0.0, 1.0);
}

std::vector<uint8_t> greyTable(const DensityGrid& grid, const GreyWindow& window) {
    std::vector<uint8_t> table(size_t(kMostDensity) + 1);
    for (size_t density = 0; density < table.size(); ++density)
        table[density] = uint8_t(std::lround(255 * greyOf(window, valueOf(grid, double(density)))));
    return table;
}

Eigen::Vector2d greyOfDensity(const DensityGrid& grid, const GreyWindow& window) {
    const double black = densityOf(grid, window.level - window.width / 2) / kMostDensity,
                 white = densityOf(grid, window.level + window.width / 2) / kMostDensity;
    return {1 / (white - black), -black / (white - black)};
}

GreyWindow startWindow(const DensityGrid& grid) {
    const double high = grid.value_at_65535;
    const double low =
        std::max(grid.value_at_0, grid.iso_value - kSofterShare * std::max(high - grid.iso_value, 0.0));
    return {std::max(high - low, kNarrowest * rangeOf(grid)), (low + high) / 2};
}

GreyWindow draggedWindow(const GreyWindow& window, const DensityGrid& grid, double right, double down) {
    const double range = rangeOf(grid);
    return {std::clamp(window.width + right * range, kNarrowest * range, 2 * range),
            std::clamp(window.level + down * range, grid.value_at_0 - range, grid.value_at_65535 + range)};
}

std::string textOf(const GreyWindow& window) {
    char text[64];
    std::snprintf(text, sizeof text, "W %.0f L %.0f", window.width, window.level);
    return text;
}

DensitySampler::DensitySampler(const DensityStore& store)
    : store_(store),
      grid_(*store.grid()),
      bricks_(size_t(brickCount(grid_))),
      is_known_(size_t(brickCount(grid_))) {
    uint32_t stride = 1;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<AxisPlace>& places = places_[size_t(axis)];
        places.resize(size_t(grid_.voxels[axis]));
        for (int i = 0; i < grid_.voxels[axis]; ++i)
            places[size_t(i)] = {brickOf(grid_, i * Eigen::Vector3i::Unit(axis)),
                                 uint32_t(i % grid_.brick_edge) * stride};
        stride *= uint32_t(grid_.brick_edge);
    }
}

const DensityBrick* DensitySampler::brick(uint32_t number) const {
    if (!is_known_[number]) {
        is_known_[number] = true;
        bricks_[number] = store_.find(number);
    }
    return bricks_[number];
}

// Returns how many of the corners count; 0 outside of the scan.
int DensitySampler::cornersAround(const Eigen::Vector3d& voxel, std::array<Corner, 8>& corners) const {
    struct Side {
        AxisPlace place;
        double weight;
    };
    std::array<std::array<Side, 2>, 3> sides;
    std::array<int, 3> counts;
    for (int axis = 0; axis < 3; ++axis) {
        const int last = grid_.voxels[axis] - 1;
        if (!(voxel[axis] >= -0.5 && voxel[axis] <= last + 0.5)) return 0;
        const double within = std::clamp(voxel[axis], 0.0, double(last));
        int low = int(within);
        double fraction = within - low;
        if (fraction > 1 - kOnVoxel) ++low, fraction = 0;
        const std::vector<AxisPlace>& places = places_[size_t(axis)];
        sides[size_t(axis)][0] = {places[size_t(low)], 1 - fraction};
        counts[size_t(axis)] = fraction < kOnVoxel ? 1 : 2;
        if (fraction >= kOnVoxel) sides[size_t(axis)][1] = {places[size_t(low) + 1], fraction};
    }
    int n = 0;
    for (int k = 0; k < counts[2]; ++k)
        for (int j = 0; j < counts[1]; ++j)
            for (int i = 0; i < counts[0]; ++i) {
                const Side &x = sides[0][size_t(i)], &y = sides[1][size_t(j)], &z = sides[2][size_t(k)];
                corners[size_t(n++)] = {x.place.brick + y.place.brick + z.place.brick,
                                        x.place.index + y.place.index + z.place.index,
                                        x.weight * y.weight * z.weight};
            }
    return n;
}

SampledDensity DensitySampler::atVoxel(const Eigen::Vector3d& voxel) const {
    std::array<Corner, 8> corners;
    const int n = cornersAround(voxel, corners);
    if (n == 0) return {};
    double scanned = 0, present = 0, weights = 0;
    bool was_changed = false;
    for (int i = 0; i < n; ++i) {
        const Corner& corner = corners[size_t(i)];
        const DensityBrick* const held = brick(corner.brick);
        if (!held) return {SliceState::kLoading, 0, 0, false};
        const uint16_t as_scanned = held->scanned[corner.index];
        const uint16_t now = held->present.empty() ? as_scanned : held->present[corner.index];
        scanned += corner.weight * as_scanned;
        present += corner.weight * now;
        weights += corner.weight;
        was_changed = was_changed || now != as_scanned;
    }
    return {SliceState::kHere, uint16_t(std::lround(scanned / weights)),
            uint16_t(std::lround(present / weights)), was_changed};
}

// The densities there must be known.
Eigen::Vector3f DensitySampler::colourAtVoxel(const Eigen::Vector3d& voxel,
                                              const BoneColours& colours) const {
    std::array<Corner, 8> corners;
    const int n = cornersAround(voxel, corners);
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    float weights = 0;
    for (int i = 0; i < n; ++i) {
        const Corner& corner = corners[size_t(i)];
        const DensityBrick& held = *brick(corner.brick);
        const uint8_t material = held.materials.empty() ? uint8_t(0) : held.materials[corner.index];
        const float weight = float(corner.weight) * (1.0f + held.scanned[corner.index]);
        sum += weight * colours[material];
        weights += weight;
    }
    return sum / weights;
}

SliceImage DensitySampler::image(const SlicePlane& plane, const BoneColours* colours) const {
    SliceImage image;
    image.width = plane.width;
    image.height = plane.height;
    const size_t pixels = size_t(plane.width) * size_t(plane.height);
    image.scanned.resize(pixels);
    image.present.resize(pixels);
    image.state.resize(pixels);
    if (colours) image.colours.resize(4 * pixels);
    const Eigen::Vector3d right = plane.right_V.cwiseQuotient(grid_.spacing_m),
                          down = plane.down_V.cwiseQuotient(grid_.spacing_m),
                          corner = voxelAt(plane.corner_V);
    size_t pixel = 0;
    for (int row = 0; row < plane.height; ++row)
        for (int column = 0; column < plane.width; ++column, ++pixel) {
            const Eigen::Vector3d voxel = corner + column * right + row * down;
            const SampledDensity sample = atVoxel(voxel);
            image.state[pixel] = sample.state;
            image.scanned[pixel] = sample.scanned;
            image.present[pixel] = sample.present;
            if (!colours || sample.state != SliceState::kHere) continue;
            const Eigen::Vector3f colour = colourAtVoxel(voxel, *colours);
            for (size_t channel = 0; channel < 3; ++channel)
                image.colours[4 * pixel + channel] =
                    uint16_t(std::lround(colour[Eigen::Index(channel)] * kFull));
            image.colours[4 * pixel + 3] = kFull;
        }
    return image;
}

std::vector<uint8_t> coloursOf(const SliceImage& image, const DensityGrid& grid, const GreyWindow& window) {
    const std::vector<uint8_t> table = greyTable(grid, window);
    const double iso = densityOf(grid, grid.iso_value);
    std::vector<uint8_t> rgba;
    rgba.reserve(4 * image.state.size());
    const auto put = [&](const Rgb& colour) {
        rgba.insert(rgba.end(), {colour[0], colour[1], colour[2], 255});
    };
    const auto tinted = [](uint8_t grey, const Rgb& tint) {
        Rgb colour;
        for (size_t i = 0; i < 3; ++i)
            colour[i] = uint8_t(std::lround(kSliceTintGrey * grey + (1 - kSliceTintGrey) * tint[i]));
        return colour;
    };
    for (size_t pixel = 0; pixel < image.state.size(); ++pixel) {
        if (image.state[pixel] == SliceState::kOutside) {
            put(kSliceOutside);
        } else if (image.state[pixel] == SliceState::kLoading) {
            put(kSliceLoading);
        } else {
            const uint8_t grey = table[image.scanned[pixel]];
            const bool was_bone = image.scanned[pixel] >= iso, is_bone = image.present[pixel] >= iso;
            put(was_bone == is_bone ? Rgb{grey, grey, grey}
                                    : tinted(grey, was_bone ? kMilledTint : kAddedTint));
        }
    }
    return rgba;
}

}  // namespace bonemill
