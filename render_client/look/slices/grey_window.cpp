#include "render_client/look/slices/grey_window.h"

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

}  // namespace bonemill
