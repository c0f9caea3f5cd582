#include "haptic_server/scans/frame/physical_frame.h"

#include <Eigen/SVD>
#include <cmath>

#include "common/base/units.h"
#include "common/base/user_error.h"

namespace bonemill {
namespace {

constexpr double kMinSpacingMm = 1e-6;
constexpr double kMaxSpacingMm = 1e4;
constexpr double kMaxOriginMm = 1e7;

void checkNumbers(const FileFrame& frame, const std::string& file) {
    const auto& s = frame.spacing_mm;
    const bool spacing_ok = s.allFinite() && s.minCoeff() >= kMinSpacingMm && s.maxCoeff() <= kMaxSpacingMm;
    if (!spacing_ok)
        throw UserError(file + ": the voxel spacing is not a sensible length; the header is damaged");
    const auto& o = frame.origin_mm;
    if (!o.allFinite() || o.cwiseAbs().maxCoeff() > kMaxOriginMm)
        throw UserError(file + ": the origin is not a sensible position; the header is damaged");
    constexpr double kMaxOffLength = 1e-2;
    const Eigen::Array3d lengths = frame.directions.colwise().norm().transpose();
    if (!((lengths - 1).abs().maxCoeff() <= kMaxOffLength))
        throw UserError(file + ": the axis directions are not unit vectors; the header is damaged");
}

void checkPerpendicular(const Eigen::Matrix3d& unit_axes, const std::string& file) {
    for (int a = 0; a < 3; ++a) {
        const double cosine = unit_axes.col(a).dot(unit_axes.col((a + 1) % 3));
        if (std::abs(cosine) > kMaxAxisCosine)
            throw UserError(file +
                            ": the axes are not perpendicular (sheared volume or gantry tilt); resample it "
                            "to a rectangular grid first");
    }
}

// Finds the rotation nearest to three almost perpendicular unit axes (polar decomposition).
Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& axes) {
    if ((axes.cwiseAbs() - axes.cwiseAbs2()).isZero(0))
        return axes;  // a permutation with signs is exact already
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(axes, Eigen::ComputeFullU | Eigen::ComputeFullV);
    return svd.matrixU() * svd.matrixV().transpose();
}

}  // namespace

void reverseAxis(RawValues& values, const Eigen::Vector3i& dims, int axis) {
    size_t stride = 1;
    for (int a = 0; a < axis; ++a) stride *= size_t(dims[a]);
    values.reverseBlocks(stride, size_t(dims[axis]));
}

void requireOneSpacing(bool is_said, bool is_given, const std::string& fields, const std::string& file) {
    if (is_said && is_given)
        throw UserError(file + ": says the voxels' size itself; leave volume.spacing_mm out");
    if (!is_said && !is_given)
        throw UserError(file +
                        ": says nothing of the voxels' size; write volume.spacing_mm, or write it into the "
                        "header in mm (" +
                        fields + ")");
}

void checkFrame(const FileFrame& frame, const std::string& file) {
    checkNumbers(frame, file);
    checkPerpendicular(frame.directions.colwise().normalized(), file);
}

bool makeRightHanded(const FileFrame& frame, const std::string& file, VolumeGeometry& geometry,
                     RawValues& values) {
    checkFrame(frame, file);
    Eigen::Matrix3d axes = frame.directions.colwise().normalized();
    Eigen::Vector3d origin_mm = frame.origin_mm;
    const bool left_handed = axes.determinant() < 0;
    if (left_handed) {
        origin_mm += axes.col(2) * frame.spacing_mm.z() * (frame.dims.z() - 1);
        axes.col(2) = -axes.col(2);
        reverseAxis(values, frame.dims, 2);
    }
    geometry.dims = frame.dims;
    geometry.spacing = frame.spacing_mm / kPerMillimetre;
    geometry.X_WV.rotation = Eigen::Quaterniond(nearestRotation(axes)).normalized();
    geometry.X_WV.position = origin_mm / kPerMillimetre;
    return left_handed;
}

}  // namespace bonemill
