// The 48 ways to store a volume along the patient's axes, by a table of sides: three letters name the
// patient's side to which the columns, rows and slices of a file go.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "haptic_server/scans/import/import_volume.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

namespace bonemill {

// Every axis to each of two sides, in every order.
inline std::vector<std::string> allOrientations() {
    std::vector<std::string> all;
    for (const char* sides : {"LPS", "LSP", "PLS", "PSL", "SLP", "SPL"})
        for (int turned = 0; turned < 8; ++turned) {
            std::string code = sides;
            for (int a = 0; a < 3; ++a)
                if (turned >> a & 1)
                    for (const char* pair : {"LR", "PA", "SI"})
                        if (sides[a] == pair[0]) code[size_t(a)] = pair[1];
            all.push_back(code);
        }
    return all;
}

// In LPS.
inline Eigen::Vector3d directionTo(char side) {
    switch (side) {
        case 'L':
            return {1, 0, 0};
        case 'R':
            return {-1, 0, 0};
        case 'P':
            return {0, 1, 0};
        case 'A':
            return {0, -1, 0};
        case 'S':
            return {0, 0, 1};
        default:  // inferior
            return {0, 0, -1};
    }
}

inline Eigen::Matrix3d axesTo(const std::string& sides) {
    Eigen::Matrix3d axes;
    for (int a = 0; a < 3; ++a) axes.col(a) = directionTo(sides[size_t(a)]);
    return axes;
}

// The sample of which index axes go to these sides; no two of its edges, voxels and offsets are alike.
inline SampleVolume sampleTo(const std::string& sides) {
    SampleVolume sample;
    sample.directions = axesTo(sides);
    return sample;
}

// The same in coordinates that grow to the sides of `space`.
inline SampleVolume inSpace(const SampleVolume& lps, const std::string& space) {
    const Eigen::Matrix3d to_space = axesTo(space).transpose();
    SampleVolume sample = lps;
    sample.directions = to_space * lps.directions;
    sample.origin_mm = to_space * lps.origin_mm;
    return sample;
}

inline std::string texts(const std::vector<double>& numbers, const char* parted_by) {
    std::string all;
    for (const double n : numbers) {
        char text[32];
        std::snprintf(text, sizeof text, "%.9g", n);
        all += (all.empty() ? "" : parted_by) + std::string(text);
    }
    return all;
}

inline std::string texts(const Eigen::Vector3d& v, const char* parted_by) {
    return texts(std::vector<double>(v.begin(), v.end()), parted_by);
}

class Places : public testing::Test {
  protected:
    void expectRead(const std::string& name, const SampleVolume& meant, double tolerance = 1e-9) {
        EXPECT_NO_THROW(expectSamePlaces(importVolumeHere(folder_ / name), meant, tolerance)) << name;
    }
    void writeNrrd(const SampleVolume& meant, const std::string& space, const std::string& sides) {
        writeNrrdFile(folder_ / "a.nrrd", inSpace(meant, sides), {}, space);
    }
    std::string niftiBytes(const SampleVolume& sample) {
        writeNiftiFile(folder_ / "a.nii", sample, {});
        return readBytes(folder_ / "a.nii");
    }
    std::string metaBytes(const SampleVolume& sample) {
        writeMetaImageFile(folder_ / "a.mha", sample, {});
        return readBytes(folder_ / "a.mha");
    }
    void expectRefused(const std::string& name, const std::string& bytes,
                       std::initializer_list<std::string> words) {
        writeBytes(folder_ / name, bytes);
        expectUserError([&] { importVolumeHere(folder_ / name); }, words);
    }

    test::TemporaryFolder folder_;
};

}  // namespace bonemill
