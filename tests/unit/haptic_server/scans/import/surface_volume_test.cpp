// A bone that is given as its surface: the voxels' iso-surface is this surface.
#include <gtest/gtest.h>

#include <cmath>

#include "haptic_server/scans/densify/densify.h"
#include "haptic_server/scans/import/import_volume.h"
#include "tests/support/stl_writer.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

std::string textPly(const test::TriangleSoup& soup, const std::string& comment) {
    std::string head = "ply\nformat ascii 1.0\n" + comment + "element vertex " +
                       std::to_string(3 * soup.size()) +
                       "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                       std::to_string(soup.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
    std::string vertices, faces;
    for (size_t t = 0; t < soup.size(); ++t) {
        for (const Eigen::Vector3f& p : soup[t]) {
            char line[96];
            std::snprintf(line, sizeof line, "%.9g %.9g %.9g\n", p.x(), p.y(), p.z());
            vertices += line;
        }
        faces += "3 " + std::to_string(3 * t) + " " + std::to_string(3 * t + 1) + " " +
                 std::to_string(3 * t + 2) + "\n";
    }
    return head + vertices + faces;
}

// The interpolated value at a place in W.
double valueAt(const RawVolume& raw, const Vector3d& p_W) {
    const Vector3d v = (raw.geometry.X_WV.inverse() * p_W).cwiseQuotient(raw.geometry.spacing);
    const Eigen::Vector3i low = v.array().floor().cast<int>();
    const Vector3d t = v - low.cast<double>();
    double value = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3i bit(corner & 1, corner >> 1 & 1, corner >> 2 & 1), at = low + bit;
        const double share =
            (bit.x() ? t.x() : 1 - t.x()) * (bit.y() ? t.y() : 1 - t.y()) * (bit.z() ? t.z() : 1 - t.z());
        const Eigen::Vector3i& n = raw.geometry.dims;
        value +=
            share *
            raw.values[size_t(at.x()) + size_t(n.x()) * (size_t(at.y()) + size_t(n.y()) * size_t(at.z()))];
    }
    return value;
}

// How far from `p` along the normal the value is half of the full one: over the ramp it falls by a quarter
// per voxel.
double surfaceOffsetInVoxels(const RawVolume& raw, const Vector3d& p, double full) {
    return (valueAt(raw, p) - full / 2) / (full / 4);
}

ImportOptions inVoxelsOf(double mm, double value = 1000) {
    ImportOptions options;
    options.surface_voxel_mm = mm;
    options.surface_value = value;
    return options;
}

class SurfaceVolume : public testing::Test {
  protected:
    RawVolume imported(const std::string& name, const std::string& bytes,
                       const ImportOptions& options = {}) const {
        writeBytes(folder_ / name, bytes);
        return importVolume(folder_ / name, options);
    }
    test::TemporaryFolder folder_;
};

TEST_F(SurfaceVolume, ofABallIsTheBallToATenthOfAVoxel) {
    constexpr double kRadius = 10;
    const Eigen::Vector3f center(30, -20, 5);
    const test::TriangleSoup ball = test::ballSoup(120, center, [](const Vector3d&) { return kRadius; });
    const RawVolume raw = imported("a.stl", test::binaryStl(ball), inVoxelsOf(0.25));
    EXPECT_TRUE(raw.geometry.spacing.isConstant(0.25e-3));
    EXPECT_EQ(raw.surface_value, 500.0);
    EXPECT_EQ(raw.values.range().high, 1000);
    EXPECT_EQ(raw.values.range().low, 0);
    for (int n = 0; n < 2000; ++n) {
        const Vector3d direction =
            Vector3d(std::sin(n * 1.7), std::cos(n * 2.3), std::sin(n * 0.9 + 1)).normalized();
        const Vector3d p = 1e-3 * (center.cast<double>() + kRadius * direction);
        ASSERT_LT(std::abs(surfaceOffsetInVoxels(raw, p, 1000)), 0.1) << direction.transpose();
    }
    EXPECT_EQ(chooseMapping(raw, {}).iso_value, 500) << "what is known needs no histogram";
}

TEST_F(SurfaceVolume, ofACubeHasItsFacesWhereTheyAre) {
    const test::TriangleSoup cube = test::boxSoup({1, 2, 3}, {9.03f, 10.03f, 11.03f});
    const RawVolume raw = imported("a.ply", textPly(cube, ""), inVoxelsOf(0.2, 2000));
    EXPECT_EQ(raw.values.range().high, 2000);
    const Vector3d low(1, 2, 3), high(9.03, 10.03, 11.03);
    for (int axis = 0; axis < 3; ++axis)
        for (double u = 0.15; u < 0.9; u += 0.07)
            for (double v = 0.15; v < 0.9; v += 0.07) {
                Vector3d p = low + (high - low).cwiseProduct(Vector3d(u, v, v));
                p[(axis + 1) % 3] = low[(axis + 1) % 3] + (high - low)[(axis + 1) % 3] * u;
                for (const double face : {low[axis], high[axis]}) {
                    p[axis] = face;
                    ASSERT_LT(std::abs(surfaceOffsetInVoxels(raw, 1e-3 * p, 2000)), 0.1) << p.transpose();
                }
            }
    // Every voxel beside faces, edges and corners has the value of its distance.
    const auto& grid = raw.geometry;
    for (size_t n = 0; n < raw.values.size(); n += 7) {
        const Eigen::Vector3i voxel(int(n) % grid.dims.x(), int(n) / grid.dims.x() % grid.dims.y(),
                                    int(n) / (grid.dims.x() * grid.dims.y()));
        const Vector3d p = 1e3 * (grid.X_WV * Vector3d(grid.spacing.cwiseProduct(voxel.cast<double>())));
        const Vector3d out = (low - p).cwiseMax(p - high);
        const double distance = out.cwiseMax(0).norm() + std::min(out.maxCoeff(), 0.0);
        ASSERT_NEAR(raw.values[n], 2000 * std::clamp(0.5 - distance / 0.8, 0.0, 1.0), 1) << p.transpose();
    }
}

TEST_F(SurfaceVolume, hasVoxelsByItsSize) {
    const RawVolume raw = imported("a.stl", test::binaryStl(test::boxSoup({0, 0, 0}, {64, 20, 20})));
    EXPECT_TRUE(raw.geometry.spacing.isConstant(0.5e-3));
    EXPECT_EQ(raw.geometry.dims.x(), 129 + 6);
}

TEST_F(SurfaceVolume, isInTheAxesThatItsFileNames) {
    const test::TriangleSoup box = test::boxSoup({10, 20, 30}, {14, 26, 38});
    const auto middle = [](const RawVolume& raw) {
        return Vector3d(
            1e3 * (raw.geometry.X_WV * Vector3d(raw.geometry.spacing.cwiseProduct(
                                                    (raw.geometry.dims.cast<double>().array() - 1).matrix()) /
                                                2)));
    };
    const RawVolume unsaid = imported("a.ply", textPly(box, ""));
    const RawVolume lps = imported("a.ply", textPly(box, "comment SPACE=LPS\n"));
    const RawVolume ras = imported("a.ply", textPly(box, "comment SPACE=RAS\n"));
    const std::string long_comment = "comment " + std::string(2000, 'x') + "\n";
    const RawVolume late = imported("a.ply", textPly(box, long_comment + "comment SPACE=RAS\n"));
    EXPECT_LT((middle(late) - Vector3d(-12, -23, 34)).norm(), 0.1);
    EXPECT_LT((middle(unsaid) - Vector3d(12, 23, 34)).norm(), 0.1);
    EXPECT_LT((middle(lps) - Vector3d(12, 23, 34)).norm(), 0.1);
    EXPECT_LT((middle(ras) - Vector3d(-12, -23, 34)).norm(), 0.1);
    EXPECT_TRUE(unsaid.lacks_patient_axes);
    EXPECT_FALSE(lps.lacks_patient_axes);
    EXPECT_FALSE(ras.lacks_patient_axes);
    EXPECT_NE(unsaid.description.find("4 x 6 x 8 mm if its numbers are mm"), std::string::npos)
        << unsaid.description;
    expectUserError([&] { imported("a.ply", textPly(box, "comment SPACE=LAS\n")); }, {"SPACE=LAS", "LPS"});
}

TEST_F(SurfaceVolume, thatIsNoSolidIsRefused) {
    const test::TriangleSoup box = test::boxSoup({0, 0, 0}, {8, 8, 8});
    test::TriangleSoup open = box;
    open.pop_back();
    expectUserError([&] { imported("a.stl", test::binaryStl(open)); }, {"a.stl", "not closed"});
    test::TriangleSoup crossed = box;
    const test::TriangleSoup other = test::boxSoup({4, 4, 4}, {12, 12, 12});
    crossed.insert(crossed.end(), other.begin(), other.end());
    expectUserError([&] { imported("a.stl", test::binaryStl(crossed)); }, {"a.stl", "told apart", "merge"});
    expectUserError([&] { imported("a.stl", test::binaryStl(box), inVoxelsOf(0.002)); },
                    {"a.stl", "surface_voxel_mm"});
    expectUserError(
        [&] {
            imported("a.stl", test::binaryStl(test::boxSoup({0, 0, 0}, {3000, 1, 1})));
        },
        {"the bone is 3000 mm large"});
    expectUserError([&] { imported("a.ply", "ply\nformat ascii 1."); }, {"a.ply", "cut short"});
    // The library would look for the end of that line for ever.
    std::string joined = textPly(box, "");
    joined.replace(joined.find("end_header\n"), 11, "end_header ");
    expectUserError([&] { imported("a.ply", joined); }, {"a.ply", "the line \"end_header\""});
    std::string many = textPly(box, "");
    many.replace(many.find("vertex 36"), 9, "vertex 36000000");
    expectUserError([&] { imported("a.ply", many); }, {"a.ply", "announces more"});
}

}  // namespace
}  // namespace bonemill
