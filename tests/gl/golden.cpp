#include "tests/gl/golden.h"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "tests/support/places.h"

namespace bonemill::test {
namespace {

constexpr int kSoftness = 2;      // pixels: half the window of the soft focus
constexpr int kVisibleStep = 12;  // of 255, in any colour

std::filesystem::path goldenPath(const std::string& name) {
    return std::filesystem::path(test::sourceDir()) / "tests/gl/golden" / (name + ".png");
}

std::array<int, 3> softened(const Picture& picture, int x, int y) {
    std::array<int, 3> sum{};
    int count = 0;
    for (int v = std::max(y - kSoftness, 0); v <= std::min(y + kSoftness, picture.height() - 1); ++v)
        for (int u = std::max(x - kSoftness, 0); u <= std::min(x + kSoftness, picture.width() - 1); ++u) {
            const auto rgb = picture.at(u, v);
            for (size_t c = 0; c < 3; ++c) sum[c] += rgb[c];
            ++count;
        }
    for (int& value : sum) value /= count;
    return sum;
}

int largestStep(const std::array<int, 3>& a, const std::array<int, 3>& b) {
    return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

}  // namespace

PictureDifference compare(const Picture& actual, const Picture& expected) {
    if (actual.width() != expected.width() || actual.height() != expected.height()) return {1, actual};
    PictureDifference difference{0, Picture(actual.width(), actual.height())};
    size_t bad = 0;
    for (int y = 0; y < actual.height(); ++y)
        for (int x = 0; x < actual.width(); ++x) {
            const int step = largestStep(softened(actual, x, y), softened(expected, x, y));
            const bool is_bad = step > kVisibleStep;
            bad += is_bad;
            const auto shown = actual.at(x, y);
            uint8_t* pixel = difference.shown.row(y) + 3 * x;
            for (size_t c = 0; c < 3; ++c) pixel[c] = uint8_t(shown[c] / 4);
            if (is_bad) pixel[0] = uint8_t(std::min(255, 120 + step));
        }
    difference.bad_part = double(bad) / (double(actual.width()) * actual.height());
    return difference;
}

Picture readPng(const std::filesystem::path& path) {
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_file(&header, path.c_str()))
        throw std::runtime_error("cannot read " + path.string() + ": " + header.message +
                                 " (BONEMILL_WRITE_GOLDEN=1 writes the golden pictures)");
    header.format = PNG_FORMAT_RGB;
    Picture picture(int(header.width), int(header.height));
    if (!png_image_finish_read(&header, nullptr, picture.row(0), 0, nullptr))
        throw std::runtime_error("cannot read " + path.string() + ": " + header.message);
    return picture;
}

Picture readGolden(const std::string& name) {
    return readPng(goldenPath(name));
}

std::string writeGolden(const Picture& picture, const std::filesystem::path& path) {
    writePng(picture, path);
    return "written, look at it, then test without BONEMILL_WRITE_GOLDEN: " + path.string();
}

std::string goldenProblem(const Picture& actual, const std::string& name) {
    if (const char* wish = std::getenv("BONEMILL_WRITE_GOLDEN"); wish && std::string(wish) == "1")
        return writeGolden(actual, goldenPath(name));
    const PictureDifference difference = compare(actual, readGolden(name));
    if (!difference.isVisible()) return "";
    const std::filesystem::path folder = testing::TempDir();
    const auto actual_path = folder / ("bonemill_" + name + "_actual.png");
    const auto difference_path = folder / ("bonemill_" + name + "_difference.png");
    writePng(actual, actual_path);
    writePng(difference.shown, difference_path);
    return std::to_string(100 * difference.bad_part) + " % of the pixels differ visibly from " +
           goldenPath(name).string() + ": look at " + actual_path.string() + " and " +
           difference_path.string() + "; BONEMILL_WRITE_GOLDEN=1 writes the new pictures";
}

}  // namespace bonemill::test
