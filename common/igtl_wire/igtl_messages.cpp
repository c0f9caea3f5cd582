#include "common/igtl_wire/igtl_messages.h"

#include <cstring>

#include "common/igtl_wire/igtl_bytes.h"

namespace bonemill::igtl {
namespace {

constexpr uint16_t kAscii = 3, kUtf8 = 106;  // MIBenum of IANA
constexpr uint8_t kFloat64 = 11, kInt16 = 4;
constexpr uint8_t kLittleEndian = 2, kRas = 1;
constexpr uint8_t kPointNormals = 2;
constexpr size_t kErrorNameBytes = 20;

void appendColumn(std::string& body, const Eigen::Vector3d& column) {
    for (const double part : column) append(body, float(part));
}

void appendVectors(std::string& body, const std::vector<Eigen::Vector3f>& vectors) {
    for (const Eigen::Vector3f& vector : vectors)
        for (const float part : vector) append(body, part);
}

}  // namespace

std::string transformFrame(std::string_view device, int64_t unix_ns, const Eigen::Isometry3d& transform_mm) {
    std::string body;
    for (int column = 0; column < 4; ++column)
        appendColumn(body, transform_mm.matrix().block<3, 1>(0, column));
    return frameOf("TRANSFORM", device, unix_ns, body);
}

std::string numbersFrame(std::string_view device, int64_t unix_ns, std::span<const double> numbers) {
    std::string body;
    append(body, kFloat64);
    append(body, uint8_t(1));
    append(body, uint16_t(numbers.size()));
    for (const double number : numbers) append(body, number);
    return frameOf("NDARRAY", device, unix_ns, body);
}

std::string stringFrame(std::string_view device, int64_t unix_ns, std::string_view text) {
    const std::string_view kept = text.substr(0, UINT16_MAX);
    std::string body;
    append(body, kUtf8);
    append(body, uint16_t(kept.size()));
    body += kept;
    return frameOf("STRING", device, unix_ns, body);
}

std::string statusFrame(std::string_view device, int64_t unix_ns, StatusCode code, std::string_view text) {
    std::string body;
    append(body, uint16_t(code));
    append(body, uint64_t(0));
    body.append(kErrorNameBytes, '\0');
    body += text;
    body += '\0';
    return frameOf("STATUS", device, unix_ns, body);
}

std::string surfaceFrame(std::string_view device, int64_t unix_ns, const Surface& surface) {
    constexpr uint32_t kCorners = 3, kCellBytes = 4 * (1 + kCorners);
    const uint32_t cells = uint32_t(surface.triangles.size() / kCorners);
    std::string body;
    body.reserve(64 + surface.points.size() * 24 + size_t(cells) * kCellBytes);
    append(body, uint32_t(surface.points.size()));
    for (int none = 0; none < 4; ++none) append(body, uint32_t(0));  // vertices and lines, with their sizes
    append(body, cells);
    append(body, cells * kCellBytes);
    append(body, uint32_t(0)), append(body, uint32_t(0));  // strips
    append(body, uint32_t(surface.normals.empty() ? 0 : 1));
    appendVectors(body, surface.points);
    for (size_t n = 0; n < surface.triangles.size(); ++n) {
        if (n % kCorners == 0) append(body, kCorners);
        append(body, surface.triangles[n]);
    }
    if (surface.normals.empty()) return frameOf("POLYDATA", device, unix_ns, body);
    append(body, kPointNormals);
    append(body, uint8_t(3));
    append(body, uint32_t(surface.normals.size()));
    body += std::string_view("normals\0", 8);  // with its end an even number of bytes
    appendVectors(body, surface.normals);
    return frameOf("POLYDATA", device, unix_ns, body);
}

// OpenIGTLink's origin is the middle of the image.
std::string imageFrame(std::string_view device, int64_t unix_ns, const ImagePlace& place,
                       std::span<const int16_t> voxels) {
    const Eigen::Vector3d half = 0.5 * (place.voxels.cast<double>() - Eigen::Vector3d::Ones());
    std::string body;
    body.reserve(72 + voxels.size_bytes());
    append(body, uint16_t(1));
    append(body, uint8_t(1));
    append(body, kInt16);
    append(body, kLittleEndian);
    append(body, kRas);
    for (const int count : place.voxels) append(body, uint16_t(count));
    for (int column = 0; column < 3; ++column) appendColumn(body, place.columns.col(column));
    appendColumn(body, place.first + place.columns * half);
    for (int axis = 0; axis < 3; ++axis) append(body, uint16_t(0));
    for (const int count : place.voxels) append(body, uint16_t(count));
    const size_t header = body.size();
    body.resize(header + voxels.size_bytes());
    std::memcpy(body.data() + header, voxels.data(), voxels.size_bytes());
    return frameOf("IMAGE", device, unix_ns, body);
}

std::optional<Eigen::Affine3d> transformOf(std::string_view body) {
    if (body.size() != kTransformBytes) return std::nullopt;
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
    for (int n = 0; n < 12; ++n) transform.matrix()(n % 3, n / 3) = double(read<float>(body, 4 * size_t(n)));
    return transform.matrix().allFinite() ? std::optional(transform) : std::nullopt;
}

std::optional<std::string> stringOf(std::string_view body) {
    if (body.size() < 4) return std::nullopt;
    const uint16_t encoding = read<uint16_t>(body, 0);
    const size_t size = read<uint16_t>(body, 2);
    if ((encoding != kAscii && encoding != kUtf8) || size > kLongestString || body.size() != 4 + size)
        return std::nullopt;
    return std::string(body.substr(4));
}

}  // namespace bonemill::igtl
