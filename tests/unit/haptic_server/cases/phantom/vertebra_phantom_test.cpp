#include "haptic_server/cases/phantom/vertebra_phantom.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "haptic_server/surface/mesh/mesh_check.h"
#include "tests/support/voxel_fields.h"
#include "tests/support/whole_densities.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

const Vertebra& ofTheTables() {
    static const Vertebra vertebra;
    return vertebra;
}

double distance_mm(double x_mm, double y_mm, double z_mm, const Vertebra& vertebra = ofTheTables()) {
    return vertebra.distance(Vector3d(x_mm, y_mm, z_mm) / 1000) * 1000;
}

// Returns how far one may go from a point in the bone, or in the open, before the surface.
double reach_mm(const Vector3d& from_mm, const Vector3d& direction,
                const Vertebra& vertebra = ofTheTables()) {
    const bool starts_inside = distance_mm(from_mm.x(), from_mm.y(), from_mm.z(), vertebra) < 0;
    for (double s = 0; s < 100; s += 0.01) {
        const Vector3d p = from_mm + s * direction;
        if ((distance_mm(p.x(), p.y(), p.z(), vertebra) < 0) != starts_inside) return s;
    }
    return INFINITY;
}
double width_mm(const Vector3d& middle_mm, const Vector3d& direction,
                const Vertebra& vertebra = ofTheTables()) {
    return reach_mm(middle_mm, direction, vertebra) + reach_mm(middle_mm, -direction, vertebra);
}

const Vector3d kLeft = Vector3d::UnitX(), kBack = Vector3d::UnitY(), kUp = Vector3d::UnitZ();
const Vector3d kPedicle_mm(16.8, 22, 4.5);  // its middle, between body and arch

TEST(VertebraPhantom, HasTheSizesOfTheTables) {
    EXPECT_NEAR(width_mm({0, 0, 12}, kLeft), 45, 1.5);
    EXPECT_NEAR(width_mm({0, 0, 12}, kBack), 33, 1.5);
    EXPECT_NEAR(width_mm({17, 0, 0}, kUp), 28, 1);
    EXPECT_LT(width_mm({0, 0, 0}, kLeft), 43) << "a waist";
    EXPECT_LT(width_mm({0, 0, 0}, kUp), width_mm({18, 0, 0}, kUp)) << "hollow end plates";
    EXPECT_NEAR(width_mm({0, 24, 4.5}, kLeft), 24, 1);
    EXPECT_NEAR(width_mm({0, 24, -5}, kBack), 17, 1);
    EXPECT_NEAR(2 * (45 + reach_mm({45, 32, 6}, kLeft)), 95, 2);  // across the transverse processes
    EXPECT_NEAR(65 + reach_mm({0, 65, -8}, kBack), 69.5, 1);      // spinous process
}

TEST(VertebraPhantom, ThePedicleIsAsWideAsTheTablesSay) {
    // The width is measured across the pedicle's axis, which leans 10 degrees inwards.
    const Vector3d across = Vector3d(22, -4, 0).normalized();
    for (const double side : {1.0, -1.0}) {
        const Vector3d mirror(side, 1, 1);
        const double width = width_mm(kPedicle_mm.cwiseProduct(mirror), across.cwiseProduct(mirror));
        EXPECT_GT(width, 9);
        EXPECT_LT(width, 11);
    }
    EXPECT_NEAR(width_mm(kPedicle_mm, kUp), 14.5, 0.5);
}

TEST(VertebraPhantom, NarrowPediclesAreNarrowAndNoTwoSeedsAlike) {
    using enum VertebraKind::Pedicles;
    const Vector3d across = Vector3d(22, -4, 0).normalized();
    for (const auto& [pedicles, width] : {std::pair(kWide, 10.0), {kMiddle, 7.5}, {kNarrow, 6.0}})
        for (const uint64_t seed : {3, 4}) {
            const Vertebra vertebra({pedicles, false, seed});
            const double its = width_mm(kPedicle_mm, across, vertebra);
            EXPECT_NEAR(its, width, 0.07 * width) << "seed " << seed;
            EXPECT_NEAR(width_mm(kPedicle_mm.cwiseProduct(Vector3d(-1, 1, 1)),
                                 across.cwiseProduct(Vector3d(-1, 1, 1)), vertebra),
                        its, 1e-9);
        }
    const Vertebra one({kWide, false, 3}), other({kWide, false, 4});
    EXPECT_GT(std::abs(width_mm({0, 0, 12}, kLeft, one) - width_mm({0, 0, 12}, kLeft, other)), 0.05);
}

TEST(VertebraPhantom, APorousOneIsThinAndSoft) {
    const Vertebra firm, porous({VertebraKind::Pedicles::kWide, true, 0});
    const Vector3d middle(0, 0, 0);
    EXPECT_NEAR(porous.corticalThickness(middle), 0.65 * firm.corticalThickness(middle), 1e-12);
    VolumeGeometry part = firm.grid(1e-3);
    part.dims = {8, 8, 8};
    part.X_WV.position = Vector3d(-4, -4, -4) * 1e-3;  // in the core
    const VertebraScan a = firm.scan(part), b = porous.scan(part);
    for (size_t n = 0; n < a.labels.size(); ++n) EXPECT_NEAR(b.ct.values[n], 0.65 * a.ct.values[n], 1) << n;
}

// The shell's thickness rests on it.
TEST(VertebraPhantom, NearTheSurfaceTheDistanceIsOne) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> x(-48, 48), y(-20, 70), z(-28, 26);
    int near = 0, off = 0;
    while (near < 500) {
        const Vector3d p_mm(x(random), y(random), z(random));
        const double d_mm = distance_mm(p_mm.x(), p_mm.y(), p_mm.z());
        if (std::abs(d_mm) > 1) continue;
        ++near;
        constexpr double kStep_mm = 1e-4;
        Vector3d slope;
        for (int a = 0; a < 3; ++a) {
            const Vector3d low = p_mm - kStep_mm * Vector3d::Unit(a),
                           high = p_mm + kStep_mm * Vector3d::Unit(a);
            slope[a] = (distance_mm(high.x(), high.y(), high.z()) - distance_mm(low.x(), low.y(), low.z())) /
                       (2 * kStep_mm);
        }
        if (slope.norm() < 0.8 || slope.norm() > 1.2) ++off;  // in the fillets
        EXPECT_GT(slope.norm(), 0.3) << p_mm.transpose();
        EXPECT_LT(slope.norm(), 1.5) << p_mm.transpose();
    }
    EXPECT_LT(off, 75) << "of 500";
}

class ScannedVertebra : public testing::Test {
  protected:
    static void SetUpTestSuite() { scan_ = new VertebraScan(ofTheTables().scan(ofTheTables().grid(0.7e-3))); }
    static void TearDownTestSuite() { delete scan_; }

    static VertebraTissue tissue(size_t n) { return VertebraTissue(scan_->labels[n]); }
    static Vector3d point_mm(size_t n) {
        const VolumeGeometry& g = scan_->ct.geometry;
        const size_t nx = size_t(g.dims.x()), ny = size_t(g.dims.y());
        const Vector3d index(double(n % nx), double(n / nx % ny), double(n / (nx * ny)));
        return g.X_WV * g.spacing.cwiseProduct(index) * 1000;
    }
    template <class See>
    static void forEach(VertebraTissue tissue_wanted, See&& see) {
        for (size_t n = 0; n < scan_->labels.size(); ++n)
            if (tissue(n) == tissue_wanted) see(n);
    }

    static VertebraScan* scan_;
};
VertebraScan* ScannedVertebra::scan_ = nullptr;

// The surface is one piece with one hole through it (the canal) and nothing hollow inside: V - E + F = 0, and
// E = 3/2 F.
TEST_F(ScannedVertebra, HasAClosedSurfaceWithOneCanal) {
    DensityWindow window;
    window.low = -200;
    window.high = 1800;
    window.iso = kBoneHu;
    const VoxelVolume volume = densify(scan_->ct, window);
    const LeafLattice lattice(volume, Eigen::Vector3i::Constant(16));
    const MeshCheck check = checkMesh(test::meshAll(volume, lattice), MeshGrid(volume, lattice));
    EXPECT_TRUE(check.isClosed());
    EXPECT_EQ(check.vertices, check.triangles / 2);
    EXPECT_GT(check.volume, 50e-6);  // m³
    EXPECT_LT(check.volume, 80e-6);
}

TEST_F(ScannedVertebra, LabelsAgreeWithItsHu) {
    size_t cortical = 0, trabecular = 0;
    for (size_t n = 0; n < scan_->labels.size(); ++n) {
        const double hu = scan_->ct.values[n];
        const bool is_bone =
            tissue(n) == VertebraTissue::kCortical || tissue(n) == VertebraTissue::kTrabecular;
        ASSERT_EQ(is_bone, hu >= kBoneHu) << point_mm(n).transpose();
        cortical += tissue(n) == VertebraTissue::kCortical;
        trabecular += tissue(n) == VertebraTissue::kTrabecular;
        if (tissue(n) == VertebraTissue::kTrabecular) {
            ASSERT_GE(hu, kTrabecularLowHu);
        }
        ASSERT_LE(hu, 1800);
        ASSERT_GE(hu, kFatHu);
    }
    EXPECT_GT(trabecular, cortical / 2);
    EXPECT_GT(cortical, trabecular / 4);
}

TEST_F(ScannedVertebra, ShellIsDenseAndCoreIsNot) {
    double shell_peak = 0, core_low = 1e9, core_high = 0;
    forEach(VertebraTissue::kTrabecular, [&](size_t n) {
        const Vector3d p = point_mm(n) / 1000;
        if (-ofTheTables().distance(p) < ofTheTables().corticalThickness(p) + 1.2e-3) return;
        core_low = std::min(core_low, double(scan_->ct.values[n]));
        core_high = std::max(core_high, double(scan_->ct.values[n]));
    });
    forEach(VertebraTissue::kCortical,
            [&](size_t n) { shell_peak = std::max(shell_peak, double(scan_->ct.values[n])); });
    EXPECT_GE(core_low, 150);
    EXPECT_LE(core_high, 400);
    EXPECT_GT(core_high - core_low, 100) << "texture";
    EXPECT_GT(shell_peak, 1300);
}

TEST_F(ScannedVertebra, NerveRootsRunUnderThePedicles) {
    for (const VertebraTissue root : {VertebraTissue::kLeftRoot, VertebraTissue::kRightRoot}) {
        const double side = root == VertebraTissue::kLeftRoot ? 1 : -1;
        const double pedicle_bottom = kPedicle_mm.z() - reach_mm(kPedicle_mm, -kUp);
        double top = -1e9;
        size_t voxels = 0;
        forEach(root, [&](size_t n) {
            const Vector3d p = point_mm(n);
            ++voxels;
            EXPECT_GT(p.x() * side, 0);
            if (std::abs(p.x() * side - 17) < 1.5) top = std::max(top, p.z());
        });
        EXPECT_GT(voxels, 500u);
        EXPECT_LT(top, pedicle_bottom - 0.5);
        EXPECT_GT(top, pedicle_bottom - 5);
    }
}

TEST_F(ScannedVertebra, SacIsInTheCanalAndVesselsInFront) {
    forEach(VertebraTissue::kDuralSac, [&](size_t n) {
        const Vector3d p = point_mm(n);
        EXPECT_LT(std::hypot(p.x() / 12, (p.y() - 24) / 8.5), 1);
    });
    size_t aorta = 0;
    forEach(VertebraTissue::kVessel, [&](size_t n) { aorta += point_mm(n).y() < -18; });
    EXPECT_GT(aorta, 5000u);
}

TEST(VertebraPhantomScan, IsRepeatable) {
    VolumeGeometry part = ofTheTables().grid(1e-3);
    part.dims = {20, 20, 20};
    part.X_WV.position = Vector3d(8, 12, -6) * 1e-3;
    const VertebraScan a = ofTheTables().scan(part), b = Vertebra().scan(part);
    EXPECT_EQ(a.ct.values, b.ct.values);
    EXPECT_EQ(a.labels, b.labels);
}

}  // namespace
}  // namespace bonemill
