// Writes the stability grid as CSV and as a picture, green where the loop comes to rest and red where it does
// not.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/stability/loop_point.h"

namespace bonemill::test {

struct GridRow {
    std::string variant;
    std::string way;  // of samples and wrenches between device and server
    LoopPoint point;
    Says says = Says::kTruth;
    LoopVerdict verdict;
};

std::vector<std::string> variantsOf(const std::vector<GridRow>& rows);

// Writes stability_grid.csv, .gp and .png; the picture needs gnuplot. False: something could not be written.
bool writeGrid(const std::filesystem::path& folder, const std::vector<GridRow>& rows);
// The same for random devices: random_devices.csv, .gp and .png.
bool writeRandom(const std::filesystem::path& folder, const std::vector<GridRow>& rows);

}  // namespace bonemill::test
