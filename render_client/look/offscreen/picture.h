// It is an RGB picture in memory, and writes its PNG file.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
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

// Whoever reads `path` sees the old file or the whole new one. Throws UserError that names the path.
void writePng(const Picture& picture, const std::filesystem::path& path);

}  // namespace bonemill
