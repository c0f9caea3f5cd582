// Checks what comes off the wire of the scan's densities. It is thread-safe and never throws on any bytes
// (other than std::bad_alloc).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "proto/topics.pb.h"
#include "render_client/link/density_store/density_grid.h"

namespace bonemill {

// Every number is in a range in which a viewer can compute with it, and `air` has a bit for each brick.
bool isUsableGrid(const topics::DensityGrid& grid);

// The grid must be usable.
DensityGrid densityGridOf(const topics::DensityGrid& grid);

// What it holds is still coded.
std::optional<topics::DensityBrick> parseDensityBrick(std::span<const uint8_t> payload);

}  // namespace bonemill
