#include "common/geometry/node_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace bonemill {
namespace {

double angleBetween(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
    return std::atan2(a.cast<double>().cross(b.cast<double>()).norm(),
                      a.cast<double>().dot(b.cast<double>()));
}

TEST(OctahedralNormal, RoundTripWithinTheStatedError) {
    std::mt19937 random(1);
    std::normal_distribution<float> coordinate;
    double worst = 0;
    for (int n = 0; n < 200000; ++n) {
        const Eigen::Vector3f normal =
            Eigen::Vector3f(coordinate(random), coordinate(random), coordinate(random)).normalized();
        const OctahedralNormal packed = encodeNormal(normal);
        worst = std::max(worst, angleBetween(decodeNormal(packed.u, packed.v), normal));
    }
    EXPECT_LT(worst, 1.5 * std::numbers::pi / 180);
}

TEST(OctahedralNormal, AxesAreExact) {
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0f, 1.0f}) {
            const Eigen::Vector3f normal = sign * Eigen::Vector3f::Unit(axis);
            const OctahedralNormal packed = encodeNormal(normal);
            EXPECT_EQ(decodeNormal(packed.u, packed.v), normal);
        }
}

TEST(OctahedralNormal, EveryCodeDecodesToAUnitVector) {
    for (int u = -128; u < 128; ++u)
        for (int v = -128; v < 128; ++v) EXPECT_NEAR(decodeNormal(int8_t(u), int8_t(v)).norm(), 1, 1e-5);
}

}  // namespace
}  // namespace bonemill
