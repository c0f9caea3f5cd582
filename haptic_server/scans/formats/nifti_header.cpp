#include "haptic_server/scans/formats/nifti_header.h"

#include <zlib.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>

#include "common/base/user_error.h"
#include "common/text/printed_text.h"

namespace bonemill {
namespace {

// These are the offsets of the fields in nifti1.h.
constexpr size_t kHeaderBytes = 348;
constexpr size_t kDimOffset = 40;
constexpr size_t kDatatypeOffset = 70;
constexpr size_t kPixdimOffset = 76;
constexpr size_t kVoxOffsetOffset = 108;
constexpr size_t kSlopeOffset = 112;
constexpr size_t kInterceptOffset = 116;
constexpr size_t kUnitsOffset = 123;
constexpr size_t kQformCodeOffset = 252;
constexpr size_t kSformCodeOffset = 254;
constexpr size_t kQuaternOffset = 256;
constexpr size_t kQoffsetOffset = 268;
constexpr size_t kSrowOffset = 280;
constexpr size_t kSformEnd = 328;
constexpr size_t kMagicOffset = 344;
constexpr int kNifti2HeaderBytes = 540;
constexpr double kMaxExtensionBytes = 64 << 20;
// Two forms that say the same place it so near.
constexpr double kSameFormMm = 0.05;

class Header {
  public:
    explicit Header(const std::filesystem::path& path) {
        const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
        if (file) is_complete_ = gzread(file.get(), bytes_.data(), kHeaderBytes) == int(kHeaderBytes);
        swapped_ = at<int32_t>(0) != int32_t(kHeaderBytes);
    }
    bool isComplete() const { return is_complete_; }
    bool isSwapped() const { return swapped_; }

    template <class T>
    T at(size_t offset) const {
        std::array<char, sizeof(T)> raw;
        std::memcpy(raw.data(), bytes_.data() + offset, sizeof(T));
        if (swapped_) std::reverse(raw.begin(), raw.end());
        return std::bit_cast<T>(raw);
    }
    std::string magic() const { return {bytes_.data() + kMagicOffset, 3}; }

  private:
    std::array<char, kHeaderBytes> bytes_{};
    bool is_complete_ = false;
    bool swapped_ = false;
};

bool isGeometryFinite(const Header& header) {
    constexpr float kFarthest = 1e9f;
    const auto isFine = [&](size_t offset) { return std::abs(header.at<float>(offset)) < kFarthest; };
    for (size_t offset = kPixdimOffset; offset < kPixdimOffset + 16; offset += 4)
        if (!isFine(offset)) return false;
    for (size_t offset = kQuaternOffset; offset < kSformEnd; offset += 4)
        if (!isFine(offset)) return false;
    return true;
}

// The codes of lengths; those from 8 on are of time.
constexpr int kLengthMask = 7, kMetres = 1, kMicrometres = 3;  // 0: not said, 2: mm

double mmPerUnit(const Header& header) {
    const int unit = header.at<int8_t>(kUnitsOffset) & kLengthMask;
    return unit == kMetres ? 1000 : unit == kMicrometres ? 1e-3 : 1;
}

void checkUnit(const Header& header, const std::string& file) {
    const int unit = header.at<int8_t>(kUnitsOffset) & kLengthMask;
    if (unit > kMicrometres)
        throw UserError(file + ": its NIfTI header states lengths in a unit that there is not (xyzt_units " +
                        std::to_string(unit) + "); set it to 2 for mm");
}

bool isSet(const Header& header, size_t code_offset) {
    return header.at<int16_t>(code_offset) > 0;
}

Eigen::Vector3i dimsOf(const Header& header) {
    const int axes = header.at<int16_t>(kDimOffset);
    Eigen::Vector3i dims = Eigen::Vector3i::Ones();
    for (int a = 0; a < std::min(axes, 3); ++a) dims[a] = header.at<int16_t>(kDimOffset + 2 + 2 * size_t(a));
    return dims;
}

// The columns of the matrix are a step along each index axis. The first two axes of
// NIfTI (N) point to the right and to the front, those of LPS to the left and the back.
FileFrame frameOf(const Header& header, const Eigen::Matrix3d& step_N, const Eigen::Vector3d& origin_N) {
    const Eigen::Vector3d to_LPS = mmPerUnit(header) * Eigen::Vector3d(-1, -1, 1);
    const Eigen::Matrix3d step = to_LPS.asDiagonal() * step_N;
    FileFrame frame{.dims = dimsOf(header),
                    .spacing_mm = step.colwise().norm(),
                    .directions = step,
                    .origin_mm = to_LPS.cwiseProduct(origin_N)};
    for (int a = 0; a < 3; ++a)
        if (frame.spacing_mm[a] > 0) frame.directions.col(a) /= frame.spacing_mm[a];
    return frame;
}

FileFrame sformOf(const Header& header) {
    Eigen::Matrix3d step;
    Eigen::Vector3d origin;
    for (int row = 0; row < 3; ++row) {
        const size_t at = kSrowOffset + 16 * size_t(row);
        for (int a = 0; a < 3; ++a) step(row, a) = header.at<float>(at + 4 * size_t(a));
        origin[row] = header.at<float>(at + 12);
    }
    return frameOf(header, step, origin);
}

FileFrame qformOf(const Header& header) {
    const auto number = [&](size_t offset) { return double(header.at<float>(offset)); };
    const double b = number(kQuaternOffset), c = number(kQuaternOffset + 4), d = number(kQuaternOffset + 8);
    // The numbers are float: of a half turn their rounding would leave 0.03 degrees.
    constexpr double kRounding = 1e-7;
    const double rest = 1 - b * b - c * c - d * d;
    const double a = rest < kRounding ? 0 : std::sqrt(rest);
    Eigen::Matrix3d step = Eigen::Quaterniond(a, b, c, d).normalized().toRotationMatrix();
    for (int axis = 0; axis < 3; ++axis) step.col(axis) *= number(kPixdimOffset + 4 + 4 * size_t(axis));
    if (number(kPixdimOffset) < 0) step.col(2) = -step.col(2);  // qfac
    return frameOf(header, step,
                   {number(kQoffsetOffset), number(kQoffsetOffset + 4), number(kQoffsetOffset + 8)});
}

// How far one voxel may lie from itself.
double distanceMm(const FileFrame& a, const FileFrame& b) {
    double most = 0;
    for (int corner = 0; corner < 8; ++corner) {
        Eigen::Vector3d index;
        for (int axis = 0; axis < 3; ++axis) index[axis] = corner >> axis & 1 ? a.dims[axis] - 1 : 0;
        const auto place = [&](const FileFrame& frame) -> Eigen::Vector3d {
            return frame.origin_mm + frame.directions * frame.spacing_mm.cwiseProduct(index);
        };
        most = std::max(most, (place(a) - place(b)).norm());
    }
    return most;
}

// Neither form is set: the voxels' size is all that is known. To readers of NIfTI the axes of such a file
// point in different directions.
FileFrame plainFrame(const Header& header) {
    FileFrame frame{.dims = dimsOf(header),
                    .spacing_mm = Eigen::Vector3d::Ones(),
                    .directions = Eigen::Matrix3d::Identity(),
                    .origin_mm = Eigen::Vector3d::Zero()};
    for (int a = 0; a < 3; ++a)
        frame.spacing_mm[a] = header.at<float>(kPixdimOffset + 4 + 4 * size_t(a)) * mmPerUnit(header);
    return frame;
}

// Voxels of two sizes; a qform, which has those of pixdim, is told of instead.
void checkSizesOfSform(const Header& header, const FileFrame& frame, const std::string& file) {
    constexpr double kMaxShare = 0.01;
    const Eigen::Vector3d said_mm = plainFrame(header).spacing_mm;
    if (!((said_mm - frame.spacing_mm).cwiseQuotient(said_mm).cwiseAbs().maxCoeff() <= kMaxShare))
        throw UserError(
            file +
            printed(": its sform makes voxels of %.4g x %.4g x %.4g mm, its pixdim says ",
                    frame.spacing_mm.x(), frame.spacing_mm.y(), frame.spacing_mm.z()) +
            printed("%.4g x %.4g x %.4g mm; make them agree", said_mm.x(), said_mm.y(), said_mm.z()));
}

void takePlace(const Header& header, NiftiHeader& out) {
    const bool has_sform = isSet(header, kSformCodeOffset), has_qform = isSet(header, kQformCodeOffset);
    out.place.is_patients = has_sform || has_qform;
    out.place.frame = has_sform ? sformOf(header) : has_qform ? qformOf(header) : plainFrame(header);
    if (!has_sform || !has_qform) return;
    const double apart_mm = distanceMm(out.place.frame, qformOf(header));
    if (apart_mm <= kSameFormMm) return;
    out.remark = printed(
        "its sform and qform place voxels up to %.1f mm apart: the sform is taken, as the standard says",
        apart_mm);
}

// A slope of 0, or one that is no number, means that nothing is scaled, but some programs add the intercept
// even so; a slope that they find too small they take for 1.
void checkScale(const Header& header, const std::string& file) {
    constexpr float kMinSlope = 1e-15f;
    const float slope = header.at<float>(kSlopeOffset), intercept = header.at<float>(kInterceptOffset);
    const bool is_unscaled = slope == 0 || std::isnan(slope);
    if (std::isinf(slope) || std::isinf(intercept) || (!is_unscaled && std::isnan(intercept)))
        throw UserError(
            file +
            ": its NIfTI header scales values by no number (scl_slope, scl_inter); write the file anew");
    const bool adds = intercept != 0 && !std::isnan(intercept);
    if ((is_unscaled && adds) || (!is_unscaled && std::abs(slope) < kMinSlope))
        throw UserError(file + ": its NIfTI header has a scl_inter without a scl_slope to go with it; set " +
                        "scl_slope to 1, or scl_inter to 0");
}

void takeScale(const Header& header, NiftiHeader& out) {
    const float slope = header.at<float>(kSlopeOffset);
    if (slope == 0 || std::isnan(slope)) return;
    out.slope = slope;
    out.intercept = header.at<float>(kInterceptOffset);
}

// Programs take their absolute values or 1 where there is no sform, or give up.
void checkVoxelSize(const Header& header, const std::string& file) {
    for (size_t a = 1; a <= std::min<size_t>(size_t(header.at<int16_t>(kDimOffset)), 3); ++a)
        if (!(header.at<float>(kPixdimOffset + 4 * a) > 0))
            throw UserError(file + ": its NIfTI header states a voxel size (pixdim) that is not above 0; " +
                            "write it in mm");
}

}  // namespace

NiftiHeader readNiftiHeader(const std::filesystem::path& path) {
    const Header header(path);
    const std::string file = path.string();
    if (!header.isComplete())
        throw UserError(file + ": is too short (or its gzip is too damaged) for a NIfTI file");
    if (header.at<int32_t>(0) == kNifti2HeaderBytes)
        throw UserError(file + ": is NIfTI-2; convert it to NIfTI-1");
    if (header.at<int32_t>(0) != int32_t(kHeaderBytes) || header.magic() != "n+1")
        throw UserError(file + ": is not a single-file NIfTI-1 volume");
    const int axes = header.at<int16_t>(kDimOffset);
    bool dims_ok = axes >= 1 && axes <= 7;
    for (int a = 1; dims_ok && a <= axes; ++a) dims_ok = header.at<int16_t>(kDimOffset + 2 * size_t(a)) > 0;
    if (!dims_ok)
        throw UserError(file + ": its NIfTI header states impossible dimensions; the file is damaged");
    if (!isGeometryFinite(header))
        throw UserError(file + ": its NIfTI header holds positions that are no numbers; the file is damaged");
    const float data_offset = header.at<float>(kVoxOffsetOffset);
    if (!(data_offset >= float(kHeaderBytes) && double(data_offset) < kMaxExtensionBytes))
        throw UserError(file +
                        ": its NIfTI header puts the voxels at an impossible place; the file is damaged");
    checkScale(header, file);
    checkUnit(header, file);
    checkVoxelSize(header, file);
    NiftiHeader out{.dims = {},
                    .datatype = header.at<int16_t>(kDatatypeOffset),
                    .is_swapped = header.isSwapped(),
                    .data_offset = uint64_t(data_offset)};
    for (int a = 1; a <= axes; ++a)
        out.dims.push_back(uint64_t(header.at<int16_t>(kDimOffset + 2 * size_t(a))));
    takeScale(header, out);
    takePlace(header, out);
    checkFrame(out.place.frame, file);
    if (isSet(header, kSformCodeOffset) && !isSet(header, kQformCodeOffset))
        checkSizesOfSform(header, out.place.frame, file);
    return out;
}

}  // namespace bonemill
