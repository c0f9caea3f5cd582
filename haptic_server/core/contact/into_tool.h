// This leads from the bone's axes into the tool's. It is RT-safe.
#pragma once

#include "common/geometry/pose.h"
#include "haptic_server/core/kernels/kernels.h"
#include "haptic_server/core/tool/tool_field.h"
#include "haptic_server/core/volume/leaf_lattice.h"

namespace bonemill {

// Takes points with V's axes, measured from `origin`, to T.
template <class Scalar>
class IntoTool {
  public:
    IntoTool(const Pose& X_VT, const Eigen::Vector3d& origin) noexcept {
        const Eigen::Matrix3d R_TV = X_VT.rotation.conjugate().toRotationMatrix();
        for (int i = 0; i < 9; ++i) frame_.R[i] = Scalar(R_TV(i / 3, i % 3));
        for (int axis = 0; axis < 3; ++axis) frame_.origin[axis] = Scalar(X_VT.position[axis] - origin[axis]);
    }

    void fill(PointBatch<Scalar>& batch, const float* x, const float* y, const float* z,
              int count) const noexcept {
        batch.count = count;
        kernels().points<Scalar>().into_frame(frame_, x, y, z, count, batch.x, batch.y, batch.z);
    }

  private:
    FrameChange<Scalar> frame_;
};

// These say which octree leaves a tool can reach. They are RT-safe.

// This is the box in V around a box in T.
inline Eigen::AlignedBox3d boxInV(const Eigen::AlignedBox3d& box_T, const Pose& X_VT) noexcept {
    const Eigen::Matrix3d spread = X_VT.rotation.toRotationMatrix().cwiseAbs();
    const Eigen::Vector3d center = X_VT * box_T.center();
    const Eigen::Vector3d half = spread * (box_T.sizes() / 2);
    return {center - half, center + half};
}

struct Sphere {
    Eigen::Vector3d center;
    double radius;
};

// The sphere lies around all cells of a leaf, in V.
inline Sphere sphereAround(const IndexBox& cells, const Eigen::Vector3d& spacing) noexcept {
    const Eigen::Vector3d low = cells.min.cast<double>().cwiseProduct(spacing);
    const Eigen::Vector3d high = (cells.max.array() + 1).matrix().cast<double>().cwiseProduct(spacing);
    return {(low + high) / 2, (high - low).norm() / 2};
}

}  // namespace bonemill
