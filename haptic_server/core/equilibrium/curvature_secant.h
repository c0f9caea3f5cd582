// Learns from the steps of a solve what Gauss-Newton leaves out of the second derivative.
//
// The sum over the points of J'J is too stiff along a surface: where the normals of the tool differ from
// point to point, as they do at its edges, each resists to a part of a sliding motion that the tool's
// curvature takes back. The difference, a symmetric S, is not computed but learnt: after a step s the
// gradient has changed by y, and (J'J + S) s = y shall hold. The update is the one of Dennis, Gay and Welsch
// (1981, "An adaptive nonlinear least-squares algorithm", eq. 2.5 ff.) with their sizing, which lets S
// shrink when the contact does. It lasts over ticks, in which a contact hardly changes.
//
// All is in one coordinate system whose six units are the same. It is RT-safe, and for one thread.
#pragma once

#include <algorithm>
#include <cmath>

#include "common/geometry/pose.h"

namespace bonemill {

class CurvatureSecant {
  public:
    // What has been learnt, to be added to J'J.
    const Matrix6d& matrix() const noexcept { return S_; }
    void forget() noexcept { S_.setZero(); }
    bool isEmpty() const noexcept { return S_.isZero(0); }
    // The `step` changed the energy's gradient by `change`; `gauss_newton` is J'J behind it.
    void learn(const Vector6d& step, const Vector6d& change, const Matrix6d& gauss_newton) noexcept {
        const double along = step.dot(change), length = step.norm() * change.norm();
        if (!(along > kMinCosine * length)) return;
        const Vector6d wanted = change - gauss_newton * step;
        const double so_far = std::abs(step.dot(S_ * step));
        if (so_far > 0) S_ *= std::min(1.0, std::abs(step.dot(wanted)) / so_far);
        const Vector6d miss = wanted - S_ * step;
        const Matrix6d outer = miss * change.transpose();
        S_ += (outer + outer.transpose()) / along -
              (miss.dot(step) / (along * along)) * change * change.transpose();
        if (!S_.allFinite()) forget();
    }

  private:
    // A gradient that has turned away from the step says nothing of a minimum.
    static constexpr double kMinCosine = 1e-3;
    Matrix6d S_ = Matrix6d::Zero();
};

}  // namespace bonemill
