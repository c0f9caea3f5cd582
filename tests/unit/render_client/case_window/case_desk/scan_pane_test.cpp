#include <gtest/gtest.h>

#include "render_client/case_window/case_desk/scan_slice.h"

namespace bonemill {
namespace {

const Eigen::AlignedBox3d kBox(Eigen::Vector3d(-0.1, -0.12, 0), Eigen::Vector3d(0.1, 0.12, 0.15));

TEST(ScanPane, LeadsFromPixelsToPlacesAndBack) {
    for (const size_t axis : {0, 1, 2})
        for (const double zoom : {1.0, 3.0}) {
            const ScanPane pane = paneOver(kBox, axis, 300, 200, zoom, Eigen::Vector3d(0.02, 0.03, 0.04));
            const Eigen::Vector3d p_W = pane.toWorld({40, 150});
            EXPECT_TRUE(pane.toPixel(p_W).isApprox(Eigen::Vector2d(40, 150), 1e-9));
            EXPECT_DOUBLE_EQ(p_W[Eigen::Index(axis)], 0.02 + 0.01 * double(axis));
            const Eigen::Vector3d moved = pane.moved(Eigen::Vector3d(7, 8, 9), {40, 150});
            EXPECT_TRUE(pane.toPixel(moved).isApprox(Eigen::Vector2d(40, 150), 1e-9));
            EXPECT_DOUBLE_EQ(moved[Eigen::Index(axis)], 7 + double(axis));
        }
}

TEST(ScanPane, SeesAllOfTheScanAsRadiologistsDo) {
    const ScanPane axial = paneOver(kBox, 2, 300, 200, 1, kBox.center());
    for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector2d pixel = axial.toPixel(kBox.corner(Eigen::AlignedBox3d::CornerType(corner)));
        EXPECT_TRUE((pixel.array() > 0).all() && pixel.x() < 300 && pixel.y() < 200) << pixel.transpose();
    }
    EXPECT_GT(axial.toPixel(Eigen::Vector3d(0.05, 0, 0)).x(), 150) << "the patient's left is at the right";
    EXPECT_GT(axial.toPixel(Eigen::Vector3d(0, 0.05, 0)).y(), 100) << "the back is below";
    const ScanPane coronal = paneOver(kBox, 1, 300, 200, 1, kBox.center());
    EXPECT_LT(coronal.toPixel(Eigen::Vector3d(0, 0, 0.14)).y(), 100) << "the head is on top";
}

TEST(ScanPane, GripsWhatIsNearest) {
    const ScanPane pane = paneOver(kBox, 2, 300, 200, 1, kBox.center());
    CaseMarks marks;
    const Eigen::Vector2d middle = pane.toPixel(Eigen::Vector3d(0.01, 0.02, 0));
    EXPECT_EQ(gripAt(pane, marks, middle, 8), Grip::kCross);
    marks.region_W = Eigen::AlignedBox3d(Eigen::Vector3d(-0.01, 0, 0), Eigen::Vector3d(0.03, 0.04, 0.04));
    marks.start_W = Eigen::Vector3d(0.01, 0.02, 0);
    marks.hand_W = Eigen::Vector3d(0.06, 0.02, 0);
    EXPECT_EQ(gripAt(pane, marks, middle + Eigen::Vector2d(5, 5), 8), Grip::kRegion);
    EXPECT_EQ(gripAt(pane, marks, middle + Eigen::Vector2d(9, 0), 8), Grip::kCross);
    EXPECT_EQ(gripAt(pane, marks, pane.toPixel(*marks.hand_W), 8), Grip::kHand);
}

TEST(ScanPane, KeepsTheArrowsEndInThePane) {
    const ScanPane pane = paneOver(kBox, 2, 300, 200, 1, kBox.center());
    const Eigen::Vector3d start_W(0, -0.08, 0), near_W(0.02, -0.07, 0);
    EXPECT_TRUE(handleOf(pane, start_W, near_W).isApprox(pane.toPixel(near_W)));
    const Eigen::Vector2d end = handleOf(pane, start_W, start_W + Eigen::Vector3d(1, -1, 0));
    EXPECT_TRUE(end.y() > 5 && end.x() < 295) << end.transpose();
    const Eigen::Vector2d way = end - pane.toPixel(start_W);
    EXPECT_GT(way.x(), 0);
    EXPECT_NEAR(way.y(), -way.x(), 1e-9) << "it lies on the arrow";
}

TEST(ScanPane, TurnsTheArrowInItsPlane) {
    const ScanPane pane = paneOver(kBox, 2, 300, 200, 1, kBox.center());
    const Eigen::Vector3d start_W(0, 0, 0.05);
    const auto turnedTo = [&](const Eigen::Vector3d& hand_W, const Eigen::Vector3d& to_W) {
        return turnedHand(pane, start_W, hand_W, pane.toPixel(to_W));
    };
    const Eigen::Vector3d flat_W(0.05, 0, 0.05), steep_W(0.03, 0, 0.09);
    EXPECT_TRUE(turnedTo(flat_W, {0, 0.02, 0}).isApprox(Eigen::Vector3d::UnitY(), 1e-6));
    EXPECT_TRUE(turnedTo(steep_W, {-0.01, 0, 0}).isApprox(Eigen::Vector3d(-0.6, 0, 0.8), 1e-6))
        << "it leans as it did";
    const Eigen::Vector3d up_W(0, 0, 0.1);
    EXPECT_TRUE(turnedTo(up_W, {0.03, 0, 0}).isApprox(Eigen::Vector3d(0.6, 0, 0.8), 1e-6));
    EXPECT_TRUE(turnedTo(up_W, {0.2, 0, 0}).isApprox(Eigen::Vector3d::UnitX(), 1e-6));
    EXPECT_TRUE(turnedTo(up_W, start_W).isApprox(Eigen::Vector3d::UnitZ(), 1e-6));
}

}  // namespace
}  // namespace bonemill
