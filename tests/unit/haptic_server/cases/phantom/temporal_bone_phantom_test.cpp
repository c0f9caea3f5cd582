#include "haptic_server/cases/phantom/temporal_bone_phantom.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>

#include "common/base/units.h"
#include "haptic_server/core/volume/index_box.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;
using enum TemporalTissue;
using Pneumatisation = TemporalBoneKind::Pneumatisation;

constexpr double kSurfaceHu = 300;  // the surface beside soft tissue
constexpr double kSpaceHu = -480;   // half-way between soft tissue and air

TemporalBoneKind kindOf(uint64_t seed, Pneumatisation pneumatisation = Pneumatisation::kWell) {
    TemporalBoneKind kind;
    kind.seed = seed;
    kind.pneumatisation = pneumatisation;
    return kind;
}

// Cells, sinus, antrum, and both duras.
const Eigen::AlignedBox3d kPart_mm(Vector3d(-17, 4, -8), Vector3d(-5, 20, 7));

VolumeGeometry gridOf(const Eigen::AlignedBox3d& box_mm, double voxel_mm) {
    VolumeGeometry geometry;
    geometry.dims = (box_mm.sizes() / voxel_mm).array().floor().cast<int>() + 1;
    geometry.spacing.setConstant(voxel_mm * kMillimetre);
    geometry.X_WV.position = box_mm.min() * kMillimetre;
    return geometry;
}

template <class See>
void forEachVoxel(const VolumeGeometry& g, See&& see) {
    size_t n = 0;
    forEachIndex({Vector3i::Zero(), (g.dims.array() - 1).matrix()}, [&](const Vector3i& v) {
        see(n++, Vector3d(g.X_WV * g.spacing.cwiseProduct(v.cast<double>()) * kPerMillimetre));
    });
}

double distance_mm(const TemporalBone& bone, TemporalTissue tissue, const Vector3d& p_mm) {
    return bone.distance(tissue, p_mm * kMillimetre) * kPerMillimetre;
}

// Marks what can be reached through voxel faces from voxel `from`.
template <class IsOpen>
std::vector<bool> flood(const VolumeGeometry& g, size_t from, IsOpen&& is_open) {
    const size_t nx = size_t(g.dims.x()), ny = size_t(g.dims.y()), nz = size_t(g.dims.z());
    std::vector<bool> is_reached(nx * ny * nz);
    std::vector<size_t> next{from};
    const auto reach = [&](size_t n) {
        if (is_reached[n] || !is_open(n)) return;
        is_reached[n] = true;
        next.push_back(n);
    };
    while (!next.empty()) {
        const size_t n = next.back(), i = n % nx, j = n / nx % ny, k = n / (nx * ny);
        next.pop_back();
        if (i > 0) reach(n - 1);
        if (i + 1 < nx) reach(n + 1);
        if (j > 0) reach(n - nx);
        if (j + 1 < ny) reach(n + nx);
        if (k > 0) reach(n - nx * ny);
        if (k + 1 < nz) reach(n + nx * ny);
    }
    return is_reached;
}

// The air of cells, antrum and middle ear: what is not connected with the air around through the ear canal,
// which ends at a plane before the drum (that is thinner than these voxels).
bool isAtDrum(const Vector3d& p_mm) {
    return p_mm.x() > -12.5 && p_mm.x() < -11.5 && p_mm.y() > -12 && p_mm.y() < -1 && p_mm.z() < 0 &&
           p_mm.z() > -11;
}
struct Spaces {
    std::vector<bool> is_space;
    double volume_ml = 0, surface_cm2 = 0;
};

Spaces spacesOf(const TemporalScan& scan) {
    const VolumeGeometry& g = scan.ct.geometry;
    const auto is_air = [&](size_t n) { return scan.ct.values[n] < kSpaceHu; };
    std::vector<bool> is_open(g.voxelCount());
    forEachVoxel(g, [&](size_t n, const Vector3d& p_mm) { is_open[n] = is_air(n) && !isAtDrum(p_mm); });
    const std::vector<bool> is_outside = flood(g, 0, [&](size_t n) { return is_open[n]; });
    Spaces spaces;
    spaces.is_space.resize(is_outside.size());
    size_t voxels = 0, faces = 0;
    for (size_t n = 0; n < is_outside.size(); ++n) voxels += spaces.is_space[n] = is_air(n) && !is_outside[n];
    const size_t nx = size_t(g.dims.x()), nxy = nx * size_t(g.dims.y());
    for (size_t n = 0; n + nxy < is_outside.size(); ++n)
        for (const size_t step : {size_t(1), nx, nxy})
            faces += spaces.is_space[n] != spaces.is_space[n + step];
    constexpr double kFacesPerSurface = 1.5;  // of a surface that faces all ways
    const double voxel_cm = g.spacing.x() * 100;
    spaces.volume_ml = double(voxels) * voxel_cm * voxel_cm * voxel_cm;
    spaces.surface_cm2 = double(faces) * voxel_cm * voxel_cm / kFacesPerSurface;
    return spaces;
}

class WellPneumatisedBone : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        bone_ = new TemporalBone(kindOf(1));
        scan_ = new TemporalScan(bone_->scan(bone_->grid(0.4e-3)));
        spaces_ = new Spaces(spacesOf(*scan_));
    }
    static void TearDownTestSuite() {
        delete bone_;
        delete scan_;
        delete spaces_;
    }
    static double huAt(const Vector3d& p_mm) {
        const VolumeGeometry& g = scan_->ct.geometry;
        const Vector3d index = (p_mm * kMillimetre - g.X_WV.position).cwiseQuotient(g.spacing);
        return scan_->ct.values[placeIn(g.dims, index.array().round().cast<int>())];
    }
    // How thick the first bone is on the way from a place outside; 0 if there is none.
    static double firstBone_mm(Vector3d p_mm, const Vector3d& direction) {
        constexpr double kStep_mm = 0.1;
        double within = 0;
        for (int n = 0; n < 120; ++n, p_mm += kStep_mm * direction) {
            const bool is_bone = huAt(p_mm) > kSurfaceHu;
            if (!is_bone && within > 0) return within;
            within += is_bone ? kStep_mm : 0;
        }
        return within;
    }

    static TemporalBone* bone_;
    static TemporalScan* scan_;
    static Spaces* spaces_;
};
TemporalBone* WellPneumatisedBone::bone_ = nullptr;
TemporalScan* WellPneumatisedBone::scan_ = nullptr;
Spaces* WellPneumatisedBone::spaces_ = nullptr;

// 4 to 14 ml of air in normal mastoids, and 11.2 to 21 cm² of walls a ml in CT of such voxels: the sources
// are in docs/reference/phantoms.md.
TEST_F(WellPneumatisedBone, HasAirAndWallsAsPublished) {
    EXPECT_GT(spaces_->volume_ml, 4);
    EXPECT_LT(spaces_->volume_ml, 14);
    EXPECT_GT(spaces_->surface_cm2 / spaces_->volume_ml, 11.2);
    EXPECT_LT(spaces_->surface_cm2 / spaces_->volume_ml, 21);
}

TEST_F(WellPneumatisedBone, CellsGrowTowardsTheAntrum) {
    struct Cell {
        Vector3d sum = Vector3d::Zero();
        int samples = 0;
    };
    constexpr size_t kStride = 7;
    std::map<int, Cell> cells;
    int in_cells = 0;
    forEachVoxel(scan_->ct.geometry, [&](size_t n, const Vector3d& p_mm) {
        if (n % kStride != 0 || !spaces_->is_space[n]) return;
        const int cell = bone_->cellAt(p_mm * kMillimetre);
        if (cell < 0) return;  // middle ear
        ++in_cells;
        cells[cell].sum += p_mm;
        ++cells[cell].samples;
    });
    const Vector3d antrum(-14, 5, 0);
    std::vector<double> diameters;
    double cells_mm3 = 0;
    int of_fitting_size = 0, near = 0, far = 0;
    double near_sum = 0, far_sum = 0;
    for (const auto& [number, cell] : cells) {
        const double volume = cell.samples * double(kStride) * 0.4 * 0.4 * 0.4;
        const double diameter = std::cbrt(6 * volume / std::numbers::pi);
        diameters.push_back(diameter);
        cells_mm3 += volume;
        if (diameter > 0.5 && diameter < 6) of_fitting_size += cell.samples;
        const double away = (cell.sum / cell.samples - antrum).norm();
        if (away < 9) near_sum += diameter, ++near;
        if (away > 16) far_sum += diameter, ++far;
    }
    std::ranges::sort(diameters);
    const auto part = [&](double share) { return diameters[size_t(share * double(diameters.size() - 1))]; };
    std::printf("%zu cells, diameters p5 %.2f, p50 %.2f, p95 %.2f mm, %.0f %% of the air\n", diameters.size(),
                part(0.05), part(0.5), part(0.95), cells_mm3 / (10 * spaces_->volume_ml));
    EXPECT_GT(of_fitting_size, 0.95 * in_cells);
    ASSERT_GT(near, 20);
    ASSERT_GT(far, 50);
    EXPECT_GT(near_sum / near, 1.15 * far_sum / far);
}

TEST_F(WellPneumatisedBone, CortexIsClosedOverTheSideAndTheTegmenIsThinner) {
    double cortex_sum = 0, tegmen_sum = 0;
    int sides = 0, with_cells = 0, roofs = 0;
    for (double y = 5; y <= 15; y += 0.5)
        for (double z = -17; z <= 0; z += 0.5) {
            const double thick = firstBone_mm({4.5, y, z}, -Vector3d::UnitX());
            EXPECT_GT(thick, 1.1) << y << " " << z;
            ++sides;
            if (thick > 4) continue;  // into a wall between cells
            ++with_cells;
            cortex_sum += thick;
        }
    for (double x = -16; x <= -8; x += 0.5)
        for (double y = 2; y <= 8; y += 0.5) {
            const double thick = firstBone_mm({x, y, 9}, -Vector3d::UnitZ());
            EXPECT_GT(thick, 0.2) << x << " " << y;
            if (thick > 4) continue;
            ++roofs;
            tegmen_sum += thick;
        }
    ASSERT_GT(with_cells, sides / 2);
    ASSERT_GT(roofs, 100);
    EXPECT_GT(cortex_sum / with_cells, 1.5);
    EXPECT_LT(cortex_sum / with_cells, 3);
    EXPECT_LT(tegmen_sum / roofs, 0.8 * cortex_sum / with_cells);
}

TEST_F(WellPneumatisedBone, HasTheValuesOfItsTissues) {
    const Eigen::AlignedBox3d block(Vector3d(-31, -13, -27), Vector3d(3, 25, 10));  // away from the cuts
    std::map<TemporalTissue, int> seen;
    double high = -2000;
    forEachVoxel(scan_->ct.geometry, [&](size_t n, const Vector3d& p_mm) {
        const double hu = scan_->ct.values[n];
        high = std::max(high, hu);
        const auto tissue = TemporalTissue(scan_->labels[n]);
        if (tissue == kNone || !block.contains(p_mm) || distance_mm(*bone_, tissue, p_mm) > -0.45) return;
        if (tissue == kOssicles) {
            EXPECT_NEAR(hu, 1700, 150);
        } else {
            EXPECT_NEAR(hu, 30, 120) << int(tissue) << " at " << p_mm.transpose();
        }
        ++seen[tissue];
    });
    EXPECT_EQ(seen.size(), 5u);
    EXPECT_GT(high, 2100) << "otic capsule";
    EXPECT_LE(high, 2300);
    EXPECT_EQ(huAt({-12, 0, -25}), -1000) << "no muscle below";
    EXPECT_EQ(huAt({4.5, 10, -10}), -1000);
}

TEST(TemporalBone, AirReachesAsFarAsIsSaid) {
    const auto volume_ml = [](Pneumatisation pneumatisation) {
        const TemporalBone bone(kindOf(2, pneumatisation));
        return spacesOf(bone.scan(bone.grid(0.6e-3))).volume_ml;
    };
    const double poor = volume_ml(Pneumatisation::kPoor), sclerotic = volume_ml(Pneumatisation::kSclerotic);
    EXPECT_GT(poor, 0.7);  // the least that is published for mastoids, to below the least of normal ones
    EXPECT_LT(poor, 4);
    EXPECT_LT(sclerotic, 1.2) << "antrum and middle ear";
    EXPECT_GT(sclerotic, 0.3);
}

TEST(TemporalBone, IsThatOfItsSeed) {
    const TemporalBone bone(kindOf(1)), again(kindOf(1)), other(kindOf(2));
    const VolumeGeometry grid = gridOf(kPart_mm, 0.5);
    const TemporalScan a = bone.scan(grid), b = again.scan(grid), c = other.scan(grid);
    EXPECT_EQ(a.ct.values, b.ct.values);
    EXPECT_EQ(a.labels, b.labels);
    size_t hu = 0, labels = 0;
    for (size_t n = 0; n < a.labels.size(); ++n) {
        hu += std::abs(a.ct.values[n] - c.ct.values[n]) > 100;
        labels += a.labels[n] != c.labels[n];
    }
    EXPECT_GT(hu, a.labels.size() / 5);
    EXPECT_GT(labels, a.labels.size() / 200);
}

TEST(TemporalBone, RightIsTheMirrorImageOfLeft) {
    TemporalBoneKind kind = kindOf(3);
    const TemporalBone left(kind);
    kind.is_right = true;
    const TemporalBone right(kind);
    VolumeGeometry grid = gridOf(kPart_mm, 0.5);
    const TemporalScan l = left.scan(grid);
    grid.X_WV.position.x() = -kPart_mm.max().x() * kMillimetre;
    const TemporalScan r = right.scan(grid);
    size_t differing = 0;
    forEachIndex({Vector3i::Zero(), (grid.dims.array() - 1).matrix()}, [&](const Vector3i& v) {
        const size_t n = placeIn(grid.dims, v),
                     m = placeIn(grid.dims, {grid.dims.x() - 1 - v.x(), v.y(), v.z()});
        differing += std::abs(l.ct.values[n] - r.ct.values[m]) > 1 || l.labels[n] != r.labels[m];
    });
    EXPECT_LT(differing, 20u) << "where rounding decides";
    const VolumeGeometry of_left = left.grid(1e-3), of_right = right.grid(1e-3);
    EXPECT_EQ(of_left.dims, of_right.dims);
    EXPECT_NEAR(of_left.X_WV.position.x() + of_right.X_WV.position.x(), -(of_left.dims.x() - 1) * 1e-3, 1e-9);
}

TEST(TemporalBone, NerveIsATubeOfOnePieceWithinBone) {
    constexpr double kVoxel_mm = 0.3;
    const TemporalBone bone(kindOf(4));
    const VolumeGeometry grid = gridOf({Vector3d(-29, -11, -19), Vector3d(-13, 6, 2)}, kVoxel_mm);
    const TemporalScan scan = bone.scan(grid);
    const auto is_nerve = [&](size_t n) { return scan.labels[n] == uint8_t(kFacialNerve); };
    size_t voxels = 0, first = 0, uncovered = 0;
    std::map<int, double> area;  // by level
    forEachVoxel(grid, [&](size_t n, const Vector3d& p_mm) {
        if (is_nerve(n)) {
            if (voxels++ == 0) first = n;
            area[int(std::lround((p_mm.z() + 19) / kVoxel_mm))] += kVoxel_mm * kVoxel_mm;
        }
        const double beside = distance_mm(bone, kFacialNerve, p_mm);
        if (p_mm.z() < -6 && beside > 0.35 && beside < 0.6) uncovered += scan.ct.values[n] < kSurfaceHu;
    });
    const std::vector<bool> is_piece = flood(grid, first, is_nerve);
    EXPECT_EQ(size_t(std::count(is_piece.begin(), is_piece.end(), true)), voxels);
    EXPECT_GT(double(voxels) * std::pow(kVoxel_mm, 3), 28 * std::numbers::pi * 0.6 * 0.6)
        << "28 mm of its course";
    for (int level = 1; level * kVoxel_mm < 13; ++level) {  // the mastoid part, from below
        const double diameter = 2 * std::sqrt(area[level] / std::numbers::pi);
        EXPECT_GT(diameter, 1.1) << level;
        EXPECT_LT(diameter, 1.8) << level;
    }
    EXPECT_EQ(uncovered, 0u);
}

// How near a structure comes to another, in mm, looked for inside the first one and a box; that is a quarter
// of a millimetre exact.
template <class To>
double least_mm(const TemporalBone& bone, TemporalTissue of, const Eigen::AlignedBox3d& box_mm, To&& to_mm) {
    double least = INFINITY;
    forEachVoxel(gridOf(box_mm, 0.4), [&](size_t, const Vector3d& p_mm) {
        const double depth = -distance_mm(bone, of, p_mm);
        if (depth > 0 && depth < 0.8) least = std::min(least, to_mm(p_mm) - depth);
    });
    return least;
}

TEST(TemporalBone, StructuresKeepTheirPublishedDistances) {
    using Box = Eigen::AlignedBox3d;
    const Box sigmoid(Vector3d(-20, 8, -14), Vector3d(-5, 20, 0)),
        bulb(Vector3d(-31, -5, -20), Vector3d(-18, 4, -6)),
        nerve(Vector3d(-29, -11, -19), Vector3d(-14, 5, 2)), ear(Vector3d(-22, -9, -8), Vector3d(-14, 0, 3)),
        canals(Vector3d(-29, -7, -8), Vector3d(-18, 6, 5));
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        TemporalBoneKind kind = kindOf(seed, Pneumatisation::kSclerotic);  // made fastest
        kind.has_high_jugular = seed % 2 == 0;
        kind.has_low_dura = seed / 2 % 2 == 0;
        const TemporalBone bone(kind);
        const auto least = [&](TemporalTissue of, const Box& box, TemporalTissue to) {
            return least_mm(bone, of, box, [&](const Vector3d& p_mm) { return distance_mm(bone, to, p_mm); });
        };
        const Vector3d lateral_canal(-19, -0.8, -1);
        const double sinus_nerve = least(kSigmoidSinus, sigmoid, kFacialNerve);
        const double bulb_nerve = least(kSigmoidSinus, bulb, kFacialNerve);
        const double sinus_canal = least_mm(bone, kSigmoidSinus, sigmoid, [&](const Vector3d& p_mm) {
            return (p_mm - lateral_canal).norm();
        });
        // Mean and standard deviation are 7.2 and 1.8 mm, 5.4 and 2.2 mm (Van Osch et al., J Otolaryngol Head
        // Neck Surg, doi:10.1186/s40463-019-0324-0), and 14.6 and 1.4 mm.
        EXPECT_NEAR(sinus_nerve, 7.2, 2 * 1.8) << seed;
        EXPECT_NEAR(bulb_nerve, 5.4, 2.2) << seed;
        EXPECT_NEAR(sinus_canal, 14.6, 2.5 * 1.4) << seed;
        EXPECT_GT(least(kFacialNerve, nerve, kSemicircularCanals), 0.3) << seed;
        EXPECT_GT(least(kFacialNerve, nerve, kDura), 2) << seed;
        EXPECT_GT(least(kSemicircularCanals, canals, kDura), 1) << seed;
        EXPECT_GT(least(kSemicircularCanals, canals, kSigmoidSinus), 0.8) << seed;
        EXPECT_GT(least(kOssicles, ear, kDura), 0.8) << seed;
        EXPECT_GT(least(kOssicles, ear, kFacialNerve), 0.3) << seed;
        EXPECT_GT(least(kOssicles, ear, kSemicircularCanals), 0.6) << seed;
    }
}

TEST(TemporalBone, VariantsMoveWhatTheySay) {
    TemporalBoneKind kind = kindOf(5, Pneumatisation::kSclerotic);
    const TemporalBone normal(kind);
    kind.has_high_jugular = kind.has_low_dura = true;
    const TemporalBone changed(kind);
    // The first z of the structure on the way from z = from.
    const auto first_z = [](const TemporalBone& bone, TemporalTissue tissue, double x, double y, double from,
                            double step) {
        double z = from;
        while (std::abs(z) < 40 && distance_mm(bone, tissue, {x, y, z}) > 0) z += step;
        return z;
    };
    const auto dome = [&](const TemporalBone& bone) {
        return first_z(bone, kSigmoidSinus, -26, -0.5, 5, -0.02);
    };
    const auto roof = [&](const TemporalBone& bone, double x) {
        return first_z(bone, kDura, x, 3, -3, 0.02);
    };
    EXPECT_NEAR(dome(changed) - dome(normal), 4, 0.1);
    EXPECT_NEAR(roof(normal, -10) - roof(changed, -10), 3, 0.1);
    EXPECT_NEAR(roof(normal, -24), roof(changed, -24), 0.1) << "over the labyrinth it stays";
    // The lateral canal's top is at z = 0.5 mm; below 2.5 mm over it the tegmen is low (Ho et al., J Laryngol
    // Otol, 2016).
    EXPECT_GT(roof(normal, -14) - 0.5, 2.5);
    EXPECT_LT(roof(changed, -14) - 0.5, 2.5);
}

}  // namespace
}  // namespace bonemill
