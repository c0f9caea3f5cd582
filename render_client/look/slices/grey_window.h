// Window and level turn the scan's values into grey. The functions are pure; any thread may call them.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "render_client/link/density_store/density_store.h"
#include "render_client/look/camera/view_settings.h"

namespace bonemill {

// Returns what the scan measured (HU where it is CT) for a density, and back; the density is not rounded and
// may lie beyond its range.
double valueOf(const DensityGrid& grid, double density);
double densityOf(const DensityGrid& grid, double value);

// Returns 0 (black) to 1 (white).
double greyOf(const GreyWindow& window, double value);
// Returns the grey of every density, 0 to 255.
std::vector<uint8_t> greyTable(const DensityGrid& grid, const GreyWindow& window);

// Returns factor and summand that make grey, 0 to 1 where it is not beyond, of a density that goes from 0
// to 1.
Eigen::Vector2d greyOfDensity(const DensityGrid& grid, const GreyWindow& window);

// Returns the window that shows bone in the upper two thirds of grey and what is softer below, as far as the
// scan's range goes.
GreyWindow startWindow(const DensityGrid& grid);

// Returns the window after a drag by these parts of the pane's size: to the right is wider, down is a higher
// level, which is darker. Neither leaves the scan's range by more than its width.
GreyWindow draggedWindow(const GreyWindow& window, const DensityGrid& grid, double right, double down);

// Returns how radiologists write it: "W 2000 L 800".
std::string textOf(const GreyWindow& window);

}  // namespace bonemill
