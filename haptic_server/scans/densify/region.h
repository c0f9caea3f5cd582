// Gives a scan other voxels: cuts the part where the burr works out of it, with voxels that are fine enough
// for the burr, and makes larger ones of what is only looked at.
//
// The scan is taken for a cubic B-spline through its voxels (Unser, Splines, IEEE Signal Processing Magazine
// 16, 1999): smooth to the second derivative, and exact at the scan's own voxels. It makes nothing sharper
// than it was scanned: what the scanner blurred stays blurred, unless its blur is named.
//
// Lengths are in m. For start-up only: not RT-safe, it allocates the result, the scan's voxels around the
// region as float, and for each thread some slices.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>
#include <vector>

#include "haptic_server/core/volume/index_box.h"
#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// The grid has cubes of `voxel` along the scan's axes. It covers the box (W; the smallest one along those
// axes that holds it) as far as the centres of the scan's outermost voxels. Its dims are 0 where box and scan
// do not meet.
VolumeGeometry regionGeometry(const VolumeGeometry& scan, const Eigen::AlignedBox3d& box_W, double voxel);

// The value at each voxel of the region. The scan's values are taken within the band, and stay there unless a
// blur is taken back; whole numbers stay whole. NaN counts as the band's lower end. `blur` (m) is the
// standard deviation of the scanner's blur: it is taken back to first order before, which raises the noise;
// 0: it stays.
RawVolume resampleRegion(const RawVolume& scan, const VolumeGeometry& region, const ValueRange& band,
                         double blur = 0);

// What resampleRegion() would make of the layers of voxels around the region.
class LayersAround {
  public:
    LayersAround(const RawVolume& scan, const VolumeGeometry& region, const ValueRange& band, double blur,
                 int layers);

    // Of a voxel of the region's grid that lies in one of the layers.
    double at(const Eigen::Vector3i& voxel) const;

  private:
    struct Slab {
        IndexBox voxels;
        RawValues values;
    };
    std::vector<Slab> slabs_;
};

// The cubic B-spline is one through samples one apart, mirrored at both ends. Its coefficients depend on
// samples farther away by less than 1e-6 of their value.
inline constexpr int kSplineReach = 12;

// Samples become the spline's coefficients, in place.
void toSplineCoefficients(std::span<double> line) noexcept;

// The coefficients first .. first + 3 make the value at `at`, by these weights.
struct SplineWeights {
    std::array<int, 4> index;  // mirrored into 0 .. count - 1
    std::array<float, 4> weight;
};
SplineWeights splineWeightsAt(double at, int count) noexcept;

// From the voxels of one grid to those of another: takes the voxel indices of `to` to those of `from`.
inline Eigen::Affine3d indexMap(const VolumeGeometry& to, const VolumeGeometry& from) {
    const Pose X = from.X_WV.inverse() * to.X_WV;
    Eigen::Affine3d map = Eigen::Affine3d::Identity();
    map.linear() =
        from.spacing.cwiseInverse().asDiagonal() * X.rotation.toRotationMatrix() * to.spacing.asDiagonal();
    map.translation() = from.spacing.cwiseInverse().cwiseProduct(X.position);
    return map;
}

// Each voxel becomes the mean of `factor`^3, at their middle; those at the upper ends, of as many as there
// are. Integers stay integers, rounded. One that is not finite makes such a mean. Start-up only: it allocates
// the result.
RawVolume coarser(const RawVolume& scan, int factor);

}  // namespace bonemill
