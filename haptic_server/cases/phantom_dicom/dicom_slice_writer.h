// Writes one DICOM CT file through ITK. There is no Eigen in here (see itk_image_file.h).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace bonemill {

struct CtSlice {
    int columns = 0;
    int rows = 0;
    std::array<double, 3> spacing_mm{};
    std::array<double, 3> position_mm{};          // centre of the first pixel
    std::array<std::array<double, 3>, 3> axis{};  // row, column and slice direction in LPS
    std::span<const int16_t> hu;
    std::vector<std::pair<std::string, std::string>> tags;  // "gggg|eeee" and value
};

// Throws UserError when the file cannot be written.
void writeCtSlice(const std::filesystem::path& path, const CtSlice& slice);

}  // namespace bonemill
