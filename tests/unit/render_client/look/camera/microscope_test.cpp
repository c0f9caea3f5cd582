#include <gtest/gtest.h>

#include "render_client/look/camera/camera.h"

namespace bonemill {
namespace {

TEST(Microscope, LooksTheSameWayAtTheSameTargetAsLarge) {
    OrbitCamera orbit;
    orbit.target_W = {0.01, -0.02, 0.03};
    for (const double distance : {0.02, 0.25, 0.6}) {
        orbit.distance = distance;
        const Camera camera = microscopeCamera(orbit.view());
        EXPECT_LT((camera.target_W() - orbit.target_W).norm(), 1e-12);
        EXPECT_EQ(camera.R_WC, orbit.view().R_WC);
        EXPECT_NEAR(camera.metresPerPixel(800), orbit.view().metresPerPixel(800), 1e-12) << distance;
    }
}

TEST(Microscope, KeepsItsWorkingDistance) {
    OrbitCamera orbit;
    orbit.distance = 0.02;
    const Camera near = microscopeCamera(orbit.view());
    orbit.zoom(0.5);
    const Camera nearer = microscopeCamera(orbit.view());
    EXPECT_NEAR((near.eye_W - orbit.target_W).norm(), 0.25, 1e-12);
    EXPECT_LT((near.eye_W - nearer.eye_W).norm(), 1e-12) << "the wheel magnifies, the eye stays";
    EXPECT_LT(nearer.field_of_view, near.field_of_view);
}

}  // namespace
}  // namespace bonemill
