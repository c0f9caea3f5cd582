// Points of the bone in the tool's frame, a batch at a time. RT-safe.
#pragma once

#include "common/geometry/pose.h"
#include "haptic_server/tool/tool_field.h"

namespace bonemill {

// Points with V's axes, measured from `origin`, to T.
template <class Scalar>
struct IntoTool {
    Scalar R[9];
    Scalar p[3];

    IntoTool(const Pose& X_VT, const Eigen::Vector3d& origin) noexcept {
        const Eigen::Matrix3d R_TV = X_VT.rotation.conjugate().toRotationMatrix();
        for (int i = 0; i < 9; ++i) R[i] = Scalar(R_TV(i / 3, i % 3));
        for (int axis = 0; axis < 3; ++axis) p[axis] = Scalar(X_VT.position[axis] - origin[axis]);
    }

    template <class PointAt>
    void fill(PointBatch<Scalar>& batch, int count, PointAt&& point_at) const noexcept {
        batch.count = count;
        for (int i = 0; i < count; ++i) {
            const auto [bx, by, bz] = point_at(i);
            const Scalar x = Scalar(bx) - p[0], y = Scalar(by) - p[1], z = Scalar(bz) - p[2];
            batch.x[i] = R[0] * x + R[1] * y + R[2] * z;
            batch.y[i] = R[3] * x + R[4] * y + R[5] * z;
            batch.z[i] = R[6] * x + R[7] * y + R[8] * z;
        }
    }
};

struct Coordinates {
    float x, y, z;
};

}  // namespace bonemill
