// The contact models see the tool as signed distances φ in frame T (m, negative inside), with their gradient
// where a point touches. All queries are const, noexcept and RT-safe; any thread.
#pragma once

#include "common/geometry/pose.h"

namespace bonemill {

// These are the points of one evaluation, in T, as structure of arrays, so that the compiler can use
// vector instructions.
template <class Scalar>
struct PointBatch {
    static constexpr int kCapacity = 64;
    alignas(64) Scalar x[kCapacity];
    alignas(64) Scalar y[kCapacity];
    alignas(64) Scalar z[kCapacity];
    int count = 0;
};

// These are distances and gradients of one batch.
template <class Scalar>
struct SampleBatch {
    alignas(64) Scalar distance[PointBatch<Scalar>::kCapacity];
    alignas(64) Scalar gx[PointBatch<Scalar>::kCapacity];
    alignas(64) Scalar gy[PointBatch<Scalar>::kCapacity];
    alignas(64) Scalar gz[PointBatch<Scalar>::kCapacity];
};

// These are flat pieces of a surface, in T: no point of one is farther than `reach` from its centre.
struct PieceBatch {
    PointBatch<float> center;
    alignas(64) float nx[PointBatch<float>::kCapacity], ny[PointBatch<float>::kCapacity],
        nz[PointBatch<float>::kCapacity];  // unit
    alignas(64) float reach[PointBatch<float>::kCapacity];
};

struct ToolSample {
    double distance = 0;  // m
    Eigen::Vector3d gradient =
        Eigen::Vector3d::Zero();  // of `distance` exactly; of length 1 where that is exact
};

class ToolField {
  public:
    virtual ~ToolField() = default;

    // Writes to out[0 .. count-1] the distance, or where it is not known (far from the tool) a positive lower
    // bound of it.
    virtual void distances(const PointBatch<float>& points_T, float* out) const noexcept = 0;
    virtual void distances(const PointBatch<double>& points_T, double* out) const noexcept = 0;
    // Writes the same distances with their gradients.
    virtual void sample(const PointBatch<float>& points_T, SampleBatch<float>& out) const noexcept = 0;
    virtual void sample(const PointBatch<double>& points_T, SampleBatch<double>& out) const noexcept = 0;
    // Writes the distances of the centres to centers[0 .. count-1], and to bounds[0 .. count-1] what no point
    // of the piece falls below, in m: it is as near to the least distance as the field can tell. Behind them,
    // up to a full batch, is anything.
    virtual void nearest(const PieceBatch& pieces_T, float* centers, float* bounds) const noexcept {
        distances(pieces_T.center, centers);
        for (int i = 0; i < pieces_T.center.count; ++i) bounds[i] = centers[i] - pieces_T.reach[i];
    }
    // Returns distance and gradient at one point, in double precision.
    virtual ToolSample sample(const Eigen::Vector3d& p_T) const noexcept = 0;
    // In m: distances() and sample() of a batch are nowhere farther from the distance than this, but for
    // lower bounds.
    virtual double distanceError() const noexcept = 0;
    // The bound is nowhere above the distance.
    virtual double distanceBound(const Eigen::Vector3d& p_T) const noexcept = 0;

    // It says how long a point's distance takes, in those of a tool of two round solids.
    virtual double testCost() const noexcept = 0;

    // The distance is nowhere negative outside.
    const Eigen::AlignedBox3d& box() const noexcept { return box_; }
    // Radius of the thinnest part as far as known, m: deeper than that a point may lie nearer to the
    // far side.
    double thinnestRadius() const noexcept { return thinnest_radius_; }
    // This is the largest distance of box() from T's origin.
    double reach() const noexcept { return reach_; }

  protected:
    static constexpr double kRounding = 1e-7;  // m, of single precision some 0.1 m from T's origin

    ToolField(const Eigen::AlignedBox3d& box, double thinnest_radius) noexcept
        : box_(box), thinnest_radius_(thinnest_radius), reach_(reachOf(box)) {}
    ToolField(const ToolField&) = default;
    ToolField& operator=(const ToolField&) = default;
    void setThinnestRadius(double radius) noexcept { thinnest_radius_ = radius; }
    void setBox(const Eigen::AlignedBox3d& box) noexcept { box_ = box, reach_ = reachOf(box); }

  private:
    static double reachOf(const Eigen::AlignedBox3d& box) noexcept {
        return box.isEmpty() ? 0 : box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).norm();
    }

    Eigen::AlignedBox3d box_;
    double thinnest_radius_;
    double reach_;
};

}  // namespace bonemill
