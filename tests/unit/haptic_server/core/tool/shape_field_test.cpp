#include "haptic_server/core/tool/shape_field.h"

#include <gtest/gtest.h>

#include <random>

namespace bonemill {
namespace {

using Eigen::Vector3d;

const std::vector<ToolShape> kShapes = {
    SphereShape{{0.1e-3, 0, 0}, 1e-3},
    CapsuleShape{{0, 0.5e-3, 0.2e-3}, {0.3e-3, 3e-3, 0}, 0.6e-3},
    CylinderShape{{0, -1e-3, 0}, {0.5e-3, 1.5e-3, 0}, 0.8e-3},
    ConeShape{{0, -1e-3, 0}, {0, 1.5e-3, 0.4e-3}, 1.1e-3, 0.3e-3},
};

template <class Visit>
void forPointsInside(int count, Visit&& visit) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> coordinate(-3e-3, 3e-3);
    for (int n = 0; n < count; ++n)
        visit(Vector3d(coordinate(random), coordinate(random), coordinate(random)));
}

double oracle(const std::vector<ToolShape>& shapes, const Vector3d& p) {
    double nearest = 1e9;
    for (const ToolShape& shape : shapes) nearest = std::min(nearest, signedDistance(shape, p));
    return nearest;
}

TEST(ShapeField, DistancesAreThoseOfTheShapesAloneAndTogether) {
    std::vector<std::vector<ToolShape>> tools;
    for (const ToolShape& shape : kShapes) tools.push_back({shape});
    tools.push_back(kShapes);
    for (const auto& shapes : tools) {
        const ShapeField field(shapes);
        forPointsInside(2000, [&](const Vector3d& p) {
            PointBatch<float> floats;
            PointBatch<double> doubles;
            floats.count = doubles.count = 1;
            floats.x[0] = float(p.x()), floats.y[0] = float(p.y()), floats.z[0] = float(p.z());
            doubles.x[0] = p.x(), doubles.y[0] = p.y(), doubles.z[0] = p.z();
            float as_float;
            double as_double;
            field.distances(floats, &as_float);
            field.distances(doubles, &as_double);
            EXPECT_NEAR(as_double, oracle(shapes, p), 1e-15);
            EXPECT_NEAR(double(as_float), oracle(shapes, p), 2e-9);
            EXPECT_NEAR(field.sample(p).distance, oracle(shapes, p), 1e-15);
            EXPECT_EQ(field.distanceBound(p), field.sample(p).distance);
        });
    }
}

// This holds away from where the nearest part of the surface changes.
TEST(ShapeField, GradientIsTheDistancesDerivative) {
    constexpr double kStep = 1e-7;
    for (const ToolShape& shape : kShapes) {
        const ShapeField field({shape});
        int smooth = 0;
        forPointsInside(3000, [&](const Vector3d& p) {
            const ToolSample here = field.sample(p);
            Vector3d gradient;
            bool is_smooth = std::abs(here.distance) > 1e-5;
            for (int axis = 0; axis < 3; ++axis) {
                const ToolSample ahead = field.sample(p + kStep * Vector3d::Unit(axis));
                const ToolSample behind = field.sample(p - kStep * Vector3d::Unit(axis));
                gradient[axis] = (ahead.distance - behind.distance) / (2 * kStep);
                is_smooth = is_smooth && (ahead.gradient - behind.gradient).norm() < 2e-3 &&
                            (ahead.gradient - 2 * here.gradient + behind.gradient).norm() < 1e-6;
            }
            if (!is_smooth) return;
            ++smooth;
            EXPECT_LT((gradient - here.gradient).norm(), 1e-6);
            EXPECT_NEAR(here.gradient.norm(), 1, 1e-12);
        });
        EXPECT_GT(smooth, 1000);
    }
}

TEST(ShapeField, SpecialPlacesStayFinite) {
    for (const ToolShape& shape : kShapes) {
        const ShapeField field({shape, SphereShape{}});
        for (const Vector3d& p :
             {Vector3d(0, 0, 0), Vector3d(0, 1e-3, 0), Vector3d(0.1e-3, 0, 0), Vector3d(0, -1e-3, 0)}) {
            const ToolSample sample = field.sample(p);
            EXPECT_TRUE(std::isfinite(sample.distance));
            EXPECT_NEAR(sample.gradient.norm(), 1, 1e-9);
        }
    }
}

// A batch's gradients are those of the points alone, away from where the nearest part of the surface changes.
TEST(ShapeField, BatchesAreSampledLikeTheirPoints) {
    std::vector<std::vector<ToolShape>> tools;
    for (const ToolShape& shape : kShapes) tools.push_back({shape});
    tools.push_back(kShapes);
    const auto check = []<class Scalar>(const ShapeField& field, const Vector3d& p, double tolerance) {
        PointBatch<Scalar> batch;
        SampleBatch<Scalar> at;
        batch.count = 1;
        batch.x[0] = Scalar(p.x()), batch.y[0] = Scalar(p.y()), batch.z[0] = Scalar(p.z());
        field.sample(batch, at);
        const ToolSample alone = field.sample(p);
        EXPECT_NEAR(double(at.distance[0]), alone.distance, tolerance);
        const Vector3d gradient(double(at.gx[0]), double(at.gy[0]), double(at.gz[0]));
        EXPECT_NEAR(gradient.norm(), 1, 1e-6);
        return (gradient - alone.gradient).norm() < 1e-4;
    };
    for (const auto& shapes : tools) {
        const ShapeField field(shapes);
        int alike[2] = {};
        forPointsInside(2000, [&](const Vector3d& p) {
            alike[0] += check.operator()<float>(field, p, 2e-9);
            alike[1] += check.operator()<double>(field, p, 1e-15);
        });
        EXPECT_GE(alike[0], 1998);
        EXPECT_EQ(alike[1], 2000);
    }
}

TEST(ShapeField, GradientPointsOutOfTheNearerEndOnTheAxisToo) {
    const ShapeField field({CylinderShape{{0, 0, 0}, {0, 4e-3, 0}, 1e-3}});
    for (const double y : {-0.5e-3, 0.5e-3}) EXPECT_EQ(field.sample({0, y, 0}).gradient, Vector3d(0, -1, 0));
    for (const double y : {3.5e-3, 4.5e-3}) EXPECT_EQ(field.sample({0, y, 0}).gradient, Vector3d(0, 1, 0));
}

TEST(ShapeField, KnowsItsThinnestPartAndItsReach) {
    const ShapeField field(
        std::vector<ToolShape>{SphereShape{{0, 0, 0}, 2e-3}, CapsuleShape{{0, 0, 0}, {0, 10e-3, 0}, 1e-3}});
    EXPECT_DOUBLE_EQ(field.thinnestRadius(), 1e-3);
    EXPECT_GE(field.reach(), 11e-3);
    EXPECT_LE(field.reach(), std::hypot(11e-3, 2e-3, 2e-3) + 1e-12);
}

}  // namespace
}  // namespace bonemill
