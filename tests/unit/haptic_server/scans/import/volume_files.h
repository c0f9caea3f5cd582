// Writes small volumes in every file format byte by byte, so that the importer is checked against the
// formats' definitions and not against its own library.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// Values tell where in the file a sample stands: i + 10 j + 100 k.
struct SampleVolume {
    Eigen::Vector3i dims{5, 4, 3};
    Eigen::Vector3d spacing_mm{0.5, 0.75, 1.25};
    Eigen::Matrix3d directions = Eigen::Matrix3d::Identity();  // columns: index axes in LPS
    Eigen::Vector3d origin_mm{10, -20, 30};

    std::vector<int16_t> values() const;
    // Returns where the file says that the sample with this value lies (LPS, m).
    Eigen::Vector3d place(double value) const;
};

// Every sample of `raw` lies where `sample` says, and none is missing.
void expectSamePlaces(const RawVolume& raw, const SampleVolume& sample, double tolerance = 1e-9);

struct Storage {
    bool is_compressed = false;
    bool is_big_endian = false;
    bool is_detached = false;
};

void writeNrrdFile(const std::filesystem::path& path, const SampleVolume& sample, const Storage& storage,
                   const std::string& space = "left-posterior-superior");
// `path` ends in .nii, or .nii.gz for compressed.
void writeNiftiFile(const std::filesystem::path& path, const SampleVolume& sample, const Storage& storage);
void writeMetaImageFile(const std::filesystem::path& path, const SampleVolume& sample,
                        const Storage& storage);

struct Inv3Text {
    std::string dtype = "int16";
    std::string modality = "CT";
    double missing_bytes = 0;  // cut off the matrix
};
// Rows go from back to front, as InVesalius stores them: the sample's second axis is reversed in the file.
void writeInv3File(const std::filesystem::path& path, const SampleVolume& sample, const Inv3Text& text);

void writeBytes(const std::filesystem::path& path, const std::string& bytes);
std::string readBytes(const std::filesystem::path& path);

// The first `from` in it is `to` then; throws std::logic_error where there is none.
std::string replaced(std::string text, const std::string& from, const std::string& to);

}  // namespace bonemill
