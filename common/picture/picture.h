// An RGB picture in memory, and pictures as PNG. A picture belongs to one thread at a time; the functions are
// for any thread, and not RT-safe.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bonemill {

class Picture {
  public:
    Picture(int width, int height)
        : width_(width), height_(height), rgb_(size_t(width) * size_t(height) * 3) {}

    int width() const { return width_; }
    int height() const { return height_; }
    // Rows count from the top; each pixel has 3 bytes, sRGB.
    uint8_t* row(int y) { return rgb_.data() + size_t(y) * size_t(width_) * 3; }
    const uint8_t* row(int y) const { return rgb_.data() + size_t(y) * size_t(width_) * 3; }
    std::array<int, 3> at(int x, int y) const {
        const uint8_t* p = row(y) + size_t(x) * 3;
        return {p[0], p[1], p[2]};
    }
    bool operator==(const Picture&) const = default;

  private:
    int width_;
    int height_;
    std::vector<uint8_t> rgb_;
};

// The bytes of a PNG file; empty if it cannot be made.
std::string pngOf(const Picture& picture);
// Whoever reads `path` sees the old file or the whole new one. Throws UserError that names the path.
void writePng(const Picture& picture, const std::filesystem::path& path);

struct RgbaPixels {
    int width = 0, height = 0;
    std::vector<uint8_t> rgba;  // rows from the top
};
// Nothing if it is no PNG, or has a side of more than `max_side` pixels.
std::optional<RgbaPixels> pixelsOfPng(std::string_view png, uint32_t max_side);

}  // namespace bonemill
