// This leads from the bone's axes into the tool's. It is RT-safe.
#pragma once

#include "common/geometry/pose.h"
#include "haptic_server/core/kernels/kernels.h"
#include "haptic_server/core/tool/tool_field.h"

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

}  // namespace bonemill
