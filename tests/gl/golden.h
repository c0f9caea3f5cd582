// Compares pictures with those in the repository (tests/gl/golden).
#pragma once

#include <filesystem>
#include <string>

#include "common/picture/picture.h"

namespace bonemill::test {

struct PictureDifference {
    double bad_part = 0;  // of the pixels that differ visibly after the same soft focus of both pictures
    Picture shown{1, 1};  // where: bright red
    bool isVisible() const { return bad_part > kTolerated; }
    // Antialiasing of another Mesa version changes single pixels of outlines and letters: nearly nothing
    // after the soft focus.
    static constexpr double kTolerated = 0.0015;
};

// Pictures of different sizes differ everywhere.
PictureDifference compare(const Picture& actual, const Picture& expected);

// The message is empty when they look the same; if not it names the actual and the difference picture, which
// were written. With BONEMILL_WRITE_GOLDEN=1 in the environment the picture becomes the golden one, and the
// message says so: nothing was compared, so no test passes.
std::string goldenProblem(const Picture& actual, const std::string& name);

// Returns the message that it was written.
std::string writeGolden(const Picture& picture, const std::filesystem::path& path);

Picture readGolden(const std::string& name);

// Throws std::runtime_error when it is no picture.
Picture readPng(const std::filesystem::path& path);

}  // namespace bonemill::test
