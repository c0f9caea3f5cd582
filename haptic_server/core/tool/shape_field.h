// The tool's distances are exact, from its shapes: solids of revolution about a segment, and their union.
#pragma once

#include <vector>

#include "haptic_server/core/kernels/kernels.h"
#include "haptic_server/core/tool/tool_field.h"
#include "haptic_server/core/tool/tool_shape.h"

namespace bonemill {

// Outside of the tool the distance is exact; inside a union it is the depth below the nearest shape's
// own surface.
class ShapeField final : public ToolField {
  public:
    // There must be at least one checked shape; throws std::invalid_argument otherwise. It allocates.
    explicit ShapeField(const std::vector<ToolShape>& shapes);

    // From now on it is this shape alone. It is RT-safe.
    void become(const SphereShape& ball) noexcept;

    void distances(const PointBatch<float>& points_T, float* out) const noexcept override {
        leastDistance(points_T, out);
    }
    void distances(const PointBatch<double>& points_T, double* out) const noexcept override {
        leastDistance(points_T, out);
    }
    void sample(const PointBatch<float>& points_T, SampleBatch<float>& out) const noexcept override {
        sampleNearest(points_T, out);
    }
    void sample(const PointBatch<double>& points_T, SampleBatch<double>& out) const noexcept override {
        sampleNearest(points_T, out);
    }
    void nearest(const PieceBatch& pieces_T, float* centers, float* bounds) const noexcept override;
    ToolSample sample(const Eigen::Vector3d& p_T) const noexcept override;
    double distanceError() const noexcept override { return kRounding; }
    double distanceBound(const Eigen::Vector3d& p_T) const noexcept override;
    double testCost() const noexcept override;

  private:
    // A round one is all points within `radius[0]` of the segment, any other all within `edge_radius` of a
    // truncated cone with flat ends.
    struct Solid {
        bool is_round;
        Eigen::Vector3d from, axis, normal;  // axis: unit; normal: unit, any to the axis
        double length;
        double radius[2];
        Eigen::Vector2d side;  // unit, from the first rim to the second: along and off the axis
        double edge_radius;

        template <class Scalar>
        RoundSolid<Scalar> round() const noexcept {
            return {{Scalar(from.x()), Scalar(from.y()), Scalar(from.z())},
                    {Scalar(axis.x()), Scalar(axis.y()), Scalar(axis.z())},
                    Scalar(length),
                    Scalar(radius[0])};
        }
        template <class Scalar>
        ConeSolid<Scalar> cone() const noexcept {
            return {{Scalar(from.x()), Scalar(from.y()), Scalar(from.z())},
                    {Scalar(axis.x()), Scalar(axis.y()), Scalar(axis.z())},
                    {Scalar(normal.x()), Scalar(normal.y()), Scalar(normal.z())},
                    Scalar(length),
                    {Scalar(radius[0]), Scalar(radius[1])},
                    {Scalar(side.x()), Scalar(side.y())},
                    Scalar(edge_radius)};
        }
    };
    static Solid solidOf(const ToolShape& shape) noexcept;
    static ToolSample sampleRound(const Solid& solid, const Eigen::Vector3d& p_T) noexcept;
    static ToolSample sampleCone(const Solid& solid, const Eigen::Vector3d& p_T) noexcept;
    template <class Scalar>
    void leastDistance(const PointBatch<Scalar>& points_T, Scalar* out) const noexcept;
    template <class Scalar>
    static void sampleNearer(const Solid& solid, const PointBatch<Scalar>& points_T,
                             SampleBatch<Scalar>& out) noexcept;
    template <class Scalar>
    void sampleNearest(const PointBatch<Scalar>& points_T, SampleBatch<Scalar>& out) const noexcept;

    std::vector<Solid> solids_;
};

}  // namespace bonemill
