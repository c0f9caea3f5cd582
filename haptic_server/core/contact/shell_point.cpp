#include "haptic_server/core/contact/shell_point.h"

#include <cmath>

namespace bonemill {
namespace {

constexpr int kBracketSteps = 24;  // worst case halves the bracket every other step

float toleranceIn(const CellCorners& corners) noexcept {
    return kProjectionTolerance * corners.largest();
}

Eigen::Vector3f cornerAt(int corner) noexcept {
    return {float(corner & 1), float(corner >> 1 & 1), float(corner >> 2 & 1)};
}

// Returns the cell of the block that holds the point, `from_first` in cell steps from the
// block's first corner.
Eigen::Vector3i cellUnder(const Eigen::Vector3f& from_first, const Eigen::Vector3i& last) noexcept {
    return from_first.cast<int>().cwiseMin(last);  // never negative: truncation is floor
}

bool isWithin(const Eigen::Vector3f& from_first, const Eigen::Vector3i& last) noexcept {
    return (from_first.array() >= 0).all() && (from_first.array() <= (last.array() + 1).cast<float>()).all();
}

// Central differences are one-sided at the air border.
bool isAtBorder(const VoxelVolume& volume, const Eigen::Vector3i& cell) noexcept {
    return (cell.array() < 0).any() || (cell.array() + 1 >= volume.dims().array()).any();
}

// Counts per cell step along the axis: central differences at the corners, interpolated trilinearly.
template <int kAxis>
float centralSlope(const Density* first_corner, const size_t (&strides)[3],
                   const Eigen::Vector3f& at) noexcept {
    constexpr int kU = (kAxis + 1) % 3;
    constexpr int kV = (kAxis + 2) % 3;
    const size_t step = strides[kAxis];
    float slope = 0;
    for (int corner = 0; corner < 4; ++corner) {
        const bool high_u = corner & 1;
        const bool high_v = corner & 2;
        const Density* d = first_corner + (high_u ? strides[kU] : 0) + (high_v ? strides[kV] : 0);
        const float at_low = float(int(d[step]) - int(*(d - step)));
        const float at_high = float(int(d[2 * step]) - int(d[0]));
        const float weight = (high_u ? at[kU] : 1 - at[kU]) * (high_v ? at[kV] : 1 - at[kV]);
        slope += weight * (at_low + at[kAxis] * (at_high - at_low));
    }
    return slope / 2;
}

// The gradient is in counts per m, also at the border.
Eigen::Vector3f cornerGradients(const VoxelVolume& volume, const SurfacePlace& place) noexcept {
    Eigen::Vector3f gradient = Eigen::Vector3f::Zero();
    for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3f bit = cornerAt(corner);
        const Eigen::Vector3f weight =
            bit.cwiseProduct(place.at) +
            (Eigen::Vector3f::Ones() - bit).cwiseProduct(Eigen::Vector3f::Ones() - place.at);
        const Eigen::Vector3i voxel = place.cell + bit.cast<int>();
        gradient += weight.prod() * volume.gradient(voxel.x(), voxel.y(), voxel.z());
    }
    return gradient;
}

Eigen::Vector3f centralGradient(const VoxelVolume& volume, const Eigen::Vector3f& inverse_spacing,
                                const SurfacePlace& place) noexcept {
    if (isAtBorder(volume, place.cell)) return cornerGradients(volume, place);
    constexpr size_t kStrides[3] = {1, VoxelVolume::kStrideY, VoxelVolume::kStrideZ};
    const Density* d = volume.ownerData() + volume.offset(place.cell.x(), place.cell.y(), place.cell.z());
    return Eigen::Vector3f(centralSlope<0>(d, kStrides, place.at), centralSlope<1>(d, kStrides, place.at),
                           centralSlope<2>(d, kStrides, place.at))
        .cwiseProduct(inverse_spacing);
}

// The corner on the other side of the surface that is nearest in m; the cell must have one.
int nearestOpposite(const CellCorners& corners, bool is_inside, const Eigen::Vector3f& at,
                    const Eigen::Vector3f& spacing) noexcept {
    int nearest = 0;
    float least = INFINITY;
    for (int corner = 0; corner < 8; ++corner) {
        if ((corners.excess[size_t(corner)] >= 0) == is_inside) continue;
        const float squared = (cornerAt(corner) - at).cwiseProduct(spacing).squaredNorm();
        if (squared >= least) continue;
        least = squared;
        nearest = corner;
    }
    return nearest;
}

// It is regula falsi by the Illinois rule, between two points of the cell on different sides.
Eigen::Vector3f rootBetween(const CellCorners& corners, Eigen::Vector3f a, float at_a, Eigen::Vector3f b,
                            float at_b) noexcept {
    const float tolerance = toleranceIn(corners);
    Eigen::Vector3f middle = a;
    for (int n = 0; n < kBracketSteps; ++n) {
        middle = a + at_a / (at_a - at_b) * (b - a);
        const float excess = sampleField(corners, middle).excess;
        if (std::abs(excess) <= tolerance) break;
        if ((excess >= 0) == (at_b >= 0)) {
            at_a /= 2;
        } else {
            a = b;
            at_a = at_b;
        }
        b = middle;
        at_b = excess;
    }
    return middle.cwiseMax(0).cwiseMin(1);
}

}  // namespace

ShellProjection::ShellProjection(const VoxelVolume& volume) noexcept
    : spacing_(volume.spacing().cast<float>()),
      inverse_spacing_(volume.spacing().cwiseInverse().cast<float>()),
      steepness_((volume.spacing().maxCoeff() * volume.spacing().cwiseInverse()).cwiseAbs2().cast<float>()) {}

bool ShellProjection::walk(const VoxelVolume& volume, const IndexBox& block, const Eigen::Vector3f& start,
                           SurfacePlace& place) const noexcept {
    const Eigen::Vector3i last = block.max - block.min;
    Eigen::Vector3f from_first = start.cwiseMin((last.array() + 1).matrix().cast<float>());
    Eigen::Vector3i cell = cellUnder(from_first, last);
    CellCorners corners = readCorners(volume, block.min + cell);
    float tolerance = toleranceIn(corners);
    for (int n = 0; n <= kNewtonSteps; ++n) {
        const Eigen::Vector3f at = from_first - cell.cast<float>();
        const FieldSample field = sampleField(corners, at);
        if (std::abs(field.excess) <= tolerance) {
            place = {block.min + cell, at};
            return true;
        }
        const Eigen::Vector3f uphill = field.slope.cwiseProduct(steepness_);
        const float rise = field.slope.dot(uphill);
        if (!(rise > 0)) return false;
        const Eigen::Vector3f step = -field.excess / rise * uphill;
        if (!(step.cwiseAbs().maxCoeff() <= 1)) return false;
        from_first += step;
        if (!isWithin(from_first, last)) return false;
        const Eigen::Vector3i next = cellUnder(from_first, last);
        if (next == cell) continue;
        cell = next;
        corners = readCorners(volume, block.min + cell);
        tolerance = toleranceIn(corners);
    }
    return false;
}

SurfacePlace ShellProjection::bracket(const VoxelVolume& volume, const SurfacePlace& start) const noexcept {
    const CellCorners corners = readCorners(volume, start.cell);
    const float excess = sampleField(corners, start.at).excess;
    if (std::abs(excess) <= toleranceIn(corners)) return start;
    const int opposite = nearestOpposite(corners, excess >= 0, start.at, spacing_);
    return {start.cell,
            rootBetween(corners, start.at, excess, cornerAt(opposite), corners.excess[size_t(opposite)])};
}

Eigen::Vector3f ShellProjection::normal(const VoxelVolume& volume, const SurfacePlace& place,
                                        ShellNormals kind) const noexcept {
    const Eigen::Vector3f gradient =
        kind == ShellNormals::kCentralDifference
            ? centralGradient(volume, inverse_spacing_, place)
            : Eigen::Vector3f(sampleField(readCorners(volume, place.cell), place.at)
                                  .slope.cwiseProduct(inverse_spacing_));
    const float length = gradient.norm();
    return length > 0 ? Eigen::Vector3f(-gradient / length) : Eigen::Vector3f::Zero();
}

}  // namespace bonemill
