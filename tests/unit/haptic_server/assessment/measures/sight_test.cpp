#include <gtest/gtest.h>

#include <numbers>

#include "haptic_server/assessment/measures/technique.h"
#include "tests/unit/haptic_server/assessment/measures/hand_made_session.h"

namespace bonemill {
namespace {

// 40³ voxels of 1 mm, with a wall of bone across x at 20 mm that has a hole around y = z = 10 mm.
VoxelVolume wallWithHole() {
    VolumeGeometry geometry;
    geometry.dims = {40, 40, 40};
    geometry.spacing = Eigen::Vector3d::Constant(1e-3);
    geometry.X_WV.position = {0.1, 0, 0};
    geometry.X_WV.rotation = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ());
    VoxelVolume volume(geometry, 32768);
    volume.fill([](int i, int j, int k) {
        const bool is_hole = std::abs(j - 10) <= 2 && std::abs(k - 10) <= 2;
        return Density(i == 20 && !is_hole ? 65535 : 0);
    });
    return volume;
}

Eigen::Vector3d inW(const VoxelVolume& volume, double x, double y, double z) {
    return volume.geometry().X_WV * Eigen::Vector3d(x, y, z) * 1.0;
}

TEST(Sight, AWallHidesAndAHoleShows) {
    const VoxelVolume volume = wallWithHole();
    const auto at = [&](double x, double y, double z) { return inW(volume, x * 1e-3, y * 1e-3, z * 1e-3); };
    EXPECT_FALSE(isHidden(volume, at(5, 10, 10), at(30, 10, 10), 1e-3));
    EXPECT_TRUE(isHidden(volume, at(5, 30, 30), at(30, 30, 30), 1e-3));
    EXPECT_FALSE(isHidden(volume, at(5, 30, 30), at(15, 30, 30), 1e-3)) << "before the wall";
    EXPECT_FALSE(isHidden(volume, at(5, 30, 30), at(21, 30, 30), 3e-3)) << "the wall is within the margin";
    EXPECT_TRUE(isHidden(volume, at(-500, 30, 30), at(30, 30, 30), 1e-3)) << "an eye far outside";
    EXPECT_FALSE(isHidden(volume, at(-500, 90, 30), at(30, 90, 30), 1e-3)) << "past the volume";
    EXPECT_FALSE(isHidden(volume, at(30, 30, 30), at(30, 30, 30), 1e-3)) << "an eye at the burr";
}

// The eye is known after 2 s, looks from the one side until 4 s and from the other for the rest of 8 s.
TEST(Sight, HiddenRemovalIsCountedOnceTheEyeIsKnown) {
    test::HandMadeSession session;
    session.seconds = 8;
    session.contact = [](double) { return true; };
    session.force = [](double) { return 1.0; };
    session.removed_until = [](double t) { return 1e-9 * t; };
    Technique technique(
        {}, [](const Eigen::Vector3d& p_eye_W, const Eigen::Vector3d&, uint32_t) { return p_eye_W.x() > 0; });
    session.play([&](const TickRecord& record) {
        const double t = record.t_s;
        if (t > 2) technique.setEye(Eigen::Vector3d(t < 4 ? 1 : -1, 0, 0));
        technique.add(record);
    });
    technique.finish();
    const Figures figures = technique.figures();
    EXPECT_NEAR(test::valueOf(figures, "sight.known"), 100 * 6.0 / 8, 1);
    EXPECT_NEAR(test::valueOf(figures, "sight.unseen"), 100 * 2.0 / 6, 1);
    EXPECT_NEAR(test::valueOf(figures, "angle.view"), 90, 0.5);
}

TEST(Sight, WithoutAnEyeNothingIsSaid) {
    test::HandMadeSession session;
    session.removed_until = [](double t) { return 1e-9 * t; };
    EXPECT_EQ(findFigure(session.figures(), "sight.unseen"), nullptr);
}

}  // namespace
}  // namespace bonemill
