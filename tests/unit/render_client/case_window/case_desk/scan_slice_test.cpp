#include "render_client/case_window/case_desk/scan_slice.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/unit/haptic_server/scans/import/grid_scan.h"

namespace bonemill {
namespace {

// Values rise with x, 10 per mm; the scan's axes are turned in W.
RawVolume ramp() {
    VolumeGeometry grid;
    grid.dims = {40, 30, 20};
    grid.spacing = {1e-3, 1e-3, 2e-3};
    grid.X_WV = {{5e-3, -3e-3, 2e-3},
                 Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()))};
    return scanOf(grid, [](const Eigen::Vector3d& p_W) { return p_W.x() * 1e4; });
}

ScanPane paneOf(const RawVolume& scan, size_t axis) {
    const Eigen::AlignedBox3d box = boxOfScan(scan.geometry);
    return paneOver(box, axis, 160, 120, 1, box.center());
}

TEST(ScanSlice, ShowsTheValueOfThePlace) {
    const RawVolume scan = ramp();
    for (const size_t axis : {size_t(1), size_t(2)}) {
        const ScanPane pane = paneOf(scan, axis);
        const SliceLook look{.window = {.width = 600, .level = 0}};
        const RgbaImage image = drawSlice(scan, pane.plane(scan.geometry.X_WV), look);
        for (const double x : {-20e-3, -9e-3, 3e-3}) {
            Eigen::Vector3d p_W = boxOfScan(scan.geometry).center();
            p_W.x() = x;
            const Eigen::Vector2d pixel = pane.toPixel(p_W);
            EXPECT_NEAR(image.at(int(pixel.x()), int(pixel.y()))[0], 255 * (x * 1e4 + 300) / 600, 3) << axis;
        }
    }
}

TEST(ScanSlice, IsBlackOutside) {
    const RawVolume scan = ramp();
    const SliceLook look{.window = {.width = 1, .level = -1e6}};  // all of the scan is white
    const RgbaImage image = drawSlice(scan, paneOf(scan, 2).plane(scan.geometry.X_WV), look);
    EXPECT_EQ(image.at(0, 60)[0], 0);
    EXPECT_EQ(image.at(80, 60)[0], 255);
}

TEST(ScanSlice, DrawsTheLineWhereTheBoneBegins) {
    const RawVolume scan = ramp();
    const ScanPane pane = paneOf(scan, 2);
    const SliceLook look{.window = {.width = 1, .level = 1e6}, .iso = -100};  // all black but the line
    const RgbaImage image = drawSlice(scan, pane.plane(scan.geometry.X_WV), look);
    Eigen::Vector3d p_W = boxOfScan(scan.geometry).center();
    p_W.x() = -10e-3;
    const auto x = int(pane.toPixel(p_W).x());
    EXPECT_EQ(image.at(x, 60)[0], kBoneLine[0]);
    EXPECT_EQ(image.at(x, 60)[2], kBoneLine[2]);
    for (const int beside : {x - 4, x + 4}) EXPECT_EQ(image.at(beside, 60)[0], 0);
}

TEST(ScanSlice, DullsTheLineAroundWhatIsLeftOut) {
    VolumeGeometry grid;
    grid.dims = {60, 30, 30};
    grid.spacing = {1e-3, 1e-3, 1e-3};
    const RawVolume scan = scanOf(grid, [](const Eigen::Vector3d& p) {
        const double large = (p - Eigen::Vector3d(16e-3, 15e-3, 15e-3)).norm() - 10e-3;
        const double small = (p - Eigen::Vector3d(48e-3, 15e-3, 15e-3)).norm() - 6e-3;
        return std::clamp(-1e6 * std::min(large, small), -1000.0, 1000.0);
    });
    CaseRequest request;
    request.iso = 0;
    request.drop_pieces = {2};
    const CaseBone bone = findBone(scan, request);
    const ScanPane pane = paneOf(scan, 2);
    const SliceLook look{.window = {.width = 1, .level = 1e6}, .iso = 0, .bone = &bone};
    const RgbaImage image = drawSlice(scan, pane.plane(grid.X_WV), look);
    const auto redAt = [&](double x) {
        const Eigen::Vector2d pixel = pane.toPixel(Eigen::Vector3d(x, 15e-3, 15e-3));
        int most = 0;
        for (int d = -1; d <= 1; ++d)
            most = std::max(most, int(image.at(int(pixel.x()) + d, int(pixel.y()))[0]));
        return most;
    };
    EXPECT_GT(redAt(26e-3), 200);
    EXPECT_GT(redAt(54e-3), 20);
    EXPECT_LT(redAt(54e-3), 100);
}

TEST(ScanSlice, TintsLabelsOfAnotherGrid) {
    const RawVolume scan = ramp();
    VolumeGeometry grid;
    grid.dims = {8, 8, 8};
    grid.spacing = Eigen::Vector3d::Constant(2e-3);
    grid.X_WV.position = boxOfScan(scan.geometry).center() - Eigen::Vector3d::Constant(7e-3);
    const RawVolume labels = scanOf(grid, [&](const Eigen::Vector3d&) { return 3.0; });
    const ScanPane pane = paneOf(scan, 2);
    SliceLook look{.window = {.width = 1, .level = 1e6}, .labels = &labels};
    look.label_tints[3] = {0, 200, 0};
    const RgbaImage image = drawSlice(scan, pane.plane(scan.geometry.X_WV), look);
    EXPECT_GT(image.at(80, 60)[1], 60);
    const Eigen::Vector2d far =
        pane.toPixel(boxOfScan(scan.geometry).center() + Eigen::Vector3d(0, 12e-3, 0));
    EXPECT_EQ(image.at(int(far.x()), int(far.y()))[1], 0);
    look.label_tints = {{4, {0, 200, 0}}};
    EXPECT_EQ(drawSlice(scan, pane.plane(scan.geometry.X_WV), look).at(80, 60)[1], 0);
}

}  // namespace
}  // namespace bonemill
