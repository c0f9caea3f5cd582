// Pictures that are kept in the repository, and comparison with them.
//
// With BONEMILL_WRITE_GOLDEN=1 in the environment they are written anew instead: look at each one before it
// is committed.
#pragma once

#include <gtest/gtest.h>
#include <png.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "render_client/offscreen/picture.h"

namespace bonemill::test {

inline Picture readPng(const std::filesystem::path& path) {
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_file(&header, path.c_str()))
        throw std::runtime_error("cannot read " + path.string() + ": " + header.message);
    header.format = PNG_FORMAT_RGB;
    Picture picture(int(header.width), int(header.height));
    if (!png_image_finish_read(&header, nullptr, picture.row(0), 0, nullptr))
        throw std::runtime_error("cannot read " + path.string() + ": " + header.message);
    return picture;
}

// The share of the pixels that differ clearly: more than another driver's rounding and soft edges.
inline double differentShare(const Picture& a, const Picture& b) {
    constexpr int kClearly = 40;  // of 765, summed over the channels
    if (a.width() != b.width() || a.height() != b.height()) return 1;
    size_t different = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) {
            const auto p = a.at(x, y), q = b.at(x, y);
            different += std::abs(p[0] - q[0]) + std::abs(p[1] - q[1]) + std::abs(p[2] - q[2]) > kClearly;
        }
    return double(different) / (double(a.width()) * a.height());
}

inline void expectGolden(const Picture& picture, const std::string& name) {
    constexpr double kMostDifferent = 0.004;
    const std::filesystem::path golden =
        std::filesystem::path(BONEMILL_SOURCE_DIR) / "tests/gl/window/golden" / (name + ".png");
    if (std::getenv("BONEMILL_WRITE_GOLDEN")) return writePng(picture, golden);
    if (!std::filesystem::exists(golden)) {
        ADD_FAILURE() << golden << " is missing: write it with BONEMILL_WRITE_GOLDEN=1";
        return;
    }
    const double share = differentShare(picture, readPng(golden));
    if (share <= kMostDifferent) return;
    const std::filesystem::path actual =
        std::filesystem::path(BONEMILL_BIN_DIR) / ".." / ("window_" + name + "_actual.png");
    writePng(picture, actual);
    ADD_FAILURE() << 100 * share << " % of the picture differ from " << golden << ", at most "
                  << 100 * kMostDifferent << " % may; see " << actual.lexically_normal();
}

}  // namespace bonemill::test
