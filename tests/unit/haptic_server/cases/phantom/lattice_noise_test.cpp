#include "haptic_server/cases/phantom/lattice_noise.h"

#include <gtest/gtest.h>

namespace bonemill {
namespace {

// The first numbers of the generator's reference implementation from state 0.
TEST(LatticeNoise, IsSplitMix64) {
    EXPECT_EQ(splitMix64(0), 0xe220a8397b1dcdafu);
    EXPECT_EQ(splitMix64(0x9e3779b97f4a7c15u), 0x6e789e6aa1b965f4u);
}

TEST(LatticeNoise, IsLinearBetweenThePointsOfTheLattice) {
    const Eigen::Vector3d a(2.4, -3.6, 1.2), b(3.6, -3.6, 1.2);
    const double at_a = smoothNoise(a, 1.2), at_b = smoothNoise(b, 1.2);
    EXPECT_GT(std::abs(at_a - at_b), 0.01);
    EXPECT_NEAR(smoothNoise(0.25 * a + 0.75 * b, 1.2), 0.25 * at_a + 0.75 * at_b, 1e-9);
}

}  // namespace
}  // namespace bonemill
