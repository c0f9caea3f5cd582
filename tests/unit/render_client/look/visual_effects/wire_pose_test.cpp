#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "render_client/look/visual_effects/effect_input.h"

namespace bonemill {
namespace {

WireVector wire(std::vector<double> values) {
    return {values.begin(), values.end()};
}

TEST(WirePose, ReadsAndNormalises) {
    const auto pose = readPose(wire({1, 2, 3}), wire({0, 0, 0, 2}));
    ASSERT_TRUE(pose);
    EXPECT_EQ(pose->position, Eigen::Vector3d(1, 2, 3));
    EXPECT_DOUBLE_EQ(pose->rotation.z(), 1);
}

TEST(WirePose, RefusesWhatIsNoPose) {
    EXPECT_FALSE(readPose(wire({1, 2}), wire({1, 0, 0, 0})));
    EXPECT_FALSE(readPose(wire({1, 2, 3}), wire({1, 0, 0})));
    EXPECT_FALSE(readPose(wire({1, 2, 3}), wire({0, 0, 0, 0})));
    EXPECT_FALSE(readPose(wire({1, 2, std::nan("")}), wire({1, 0, 0, 0})));
    EXPECT_FALSE(readPose(wire({1, 2, 3}), wire({1, 0, INFINITY, 0})));
    EXPECT_FALSE(readVector(wire({})));
}

}  // namespace
}  // namespace bonemill
