// The distances of a ball around the tool point: all that proxy_3dof feels of a tool. It is RT-safe.
#pragma once

#include <cmath>

#include "haptic_server/tool/tool_field.h"

namespace bonemill {

class BallField final : public ToolField {
  public:
    explicit BallField(double radius) noexcept
        : ToolField({Eigen::Vector3d::Constant(-radius), Eigen::Vector3d::Constant(radius)}, radius),
          radius_(radius) {}

    void distances(const PointBatch<float>& points_T, float* out) const noexcept override {
        write(points_T, out);
    }
    void distances(const PointBatch<double>& points_T, double* out) const noexcept override {
        write(points_T, out);
    }
    void sample(const PointBatch<float>& points_T, SampleBatch<float>& out) const noexcept override {
        writeSample(points_T, out);
    }
    void sample(const PointBatch<double>& points_T, SampleBatch<double>& out) const noexcept override {
        writeSample(points_T, out);
    }
    ToolSample sample(const Eigen::Vector3d& p_T) const noexcept override;
    double distanceError() const noexcept override { return kRounding; }
    double distanceBound(const Eigen::Vector3d& p_T) const noexcept override { return p_T.norm() - radius_; }
    double testCost() const noexcept override { return 0.5; }

  private:
    template <class Scalar>
    void write(const PointBatch<Scalar>& points_T, Scalar* out) const noexcept;
    template <class Scalar>
    void writeSample(const PointBatch<Scalar>& points_T, SampleBatch<Scalar>& out) const noexcept;

    double radius_;
};

template <class Scalar>
void BallField::write(const PointBatch<Scalar>& points_T, Scalar* out) const noexcept {
    for (int i = 0; i < points_T.count; ++i)
        out[i] = std::sqrt(points_T.x[i] * points_T.x[i] + points_T.y[i] * points_T.y[i] +
                           points_T.z[i] * points_T.z[i]) -
                 Scalar(radius_);
}

template <class Scalar>
void BallField::writeSample(const PointBatch<Scalar>& points_T, SampleBatch<Scalar>& out) const noexcept {
    for (int i = 0; i < points_T.count; ++i) {
        const ToolSample at = sample({double(points_T.x[i]), double(points_T.y[i]), double(points_T.z[i])});
        out.distance[i] = Scalar(at.distance);
        out.gx[i] = Scalar(at.gradient.x());
        out.gy[i] = Scalar(at.gradient.y());
        out.gz[i] = Scalar(at.gradient.z());
    }
}

inline ToolSample BallField::sample(const Eigen::Vector3d& p_T) const noexcept {
    const double r = p_T.norm();
    if (r == 0) return {-radius_, Eigen::Vector3d::UnitY()};
    return {r - radius_, p_T / r};
}

}  // namespace bonemill
