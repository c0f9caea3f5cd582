#include <gtest/gtest.h>

#include "tests/unit/haptic_server/core/effects/tissue_bench.h"

namespace bonemill {
namespace {

using namespace test;
using Eigen::Vector3d;

// In this scene the nerve is where x > 4 mm.
TissueBench benchOf(double factor) {
    TissueBench bench(halfSpace({4e-3, 0, 0}, -Vector3d::UnitX()));
    bench.config.effects.materials[kNerve].stiffness_factor = factor;
    bench.config.effects.material_stiffness.emplace();
    return bench;
}

double depthAt(TissueBench& bench, double x) {
    FixedTick tick = bench.makeTick();
    const Vector3d end(x, 4e-3, kTop + kBurr - 0.4e-3);
    auto inputs = straightPath(TissueBench::at({x, 4e-3, kTop + kBurr + 0.2e-3}), end, 200, 0);
    inputs.insert(inputs.end(), 100, inputs.back());
    return bench.run(tick, inputs).back().max_penetration;
}

// The force of a ball on a plane goes with κ depth²: a quarter of κ gives twice the depth at nearly the
// same force.
TEST(MaterialStiffness, ContactYieldsByTheMaterialsFactor) {
    TissueBench bench = benchOf(0.25);
    EXPECT_NEAR(depthAt(bench, 6e-3) / depthAt(bench, 2e-3), 2, 0.1);
}

}  // namespace
}  // namespace bonemill
