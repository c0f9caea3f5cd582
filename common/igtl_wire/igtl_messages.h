// The bodies of the OpenIGTLink messages that are sent and taken here. Lengths are mm, in RAS (the patient's
// right, front and head are +), as 3D Slicer has them (docs/howto/slicer.md). Thread-safe.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/igtl_wire/igtl_frame.h"

namespace bonemill::igtl {

inline constexpr size_t kTransformBytes = 48;
inline constexpr size_t kLongestString = 2048;  // that is taken

// A whole frame each.
std::string transformFrame(std::string_view device, int64_t unix_ns, const Eigen::Isometry3d& transform_mm);
// NDARRAY, one dimension of doubles.
std::string numbersFrame(std::string_view device, int64_t unix_ns, std::span<const double> numbers);
std::string stringFrame(std::string_view device, int64_t unix_ns, std::string_view text);  // UTF-8

enum class StatusCode : uint16_t { kOk = 1, kUnknownError = 2, kNotFound = 8, kNotReady = 13 };
std::string statusFrame(std::string_view device, int64_t unix_ns, StatusCode code, std::string_view text);

struct Surface {
    std::vector<Eigen::Vector3f> points;   // mm
    std::vector<Eigen::Vector3f> normals;  // as many, or none
    std::vector<uint32_t> triangles;       // three indices each
};
std::string surfaceFrame(std::string_view device, int64_t unix_ns, const Surface& surface);

// Voxel (i, j, k) lies at first + i·columns.col(0) + j·columns.col(1) + k·columns.col(2), in mm.
struct ImagePlace {
    Eigen::Vector3i voxels;
    Eigen::Matrix3d columns;
    Eigen::Vector3d first;
};
// `voxels` are x fastest.
std::string imageFrame(std::string_view device, int64_t unix_ns, const ImagePlace& place,
                       std::span<const int16_t> voxels);

// Nothing for another size, and for what is not finite. Whether it is a rotation is the caller's to ask.
std::optional<Eigen::Affine3d> transformOf(std::string_view body);
// Nothing for what is not as long as it says, is no text of one byte per sign or UTF-8, or is longer than
// kLongestString.
std::optional<std::string> stringOf(std::string_view body);

inline const WantedType kWantedTransform{"TRANSFORM", kTransformBytes, kTransformBytes};
inline const WantedType kWantedString{"STRING", 4, 4 + kLongestString};

}  // namespace bonemill::igtl
