// The points of a shell lie on the surface, and their areas add up to it.
#include "tests/unit/haptic_server/core/contact/shell_points.h"

#include <random>

#include "tests/support/test_bodies.h"
#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

using namespace test;

std::vector<ShellPoint> allPoints(const PointShell& shell, int level, const LeafLattice& lattice) {
    std::vector<ShellPoint> all;
    for (LeafId leaf = 0; leaf < lattice.leafCount(); ++leaf) {
        const auto points = pointsOf(shell, level, leaf);
        EXPECT_EQ(points.size(), shell.pointCount(level, leaf));
        all.insert(all.end(), points.begin(), points.end());
    }
    EXPECT_EQ(all.size(), shell.pointCount(level));
    return all;
}

double totalArea(const std::vector<ShellPoint>& points) {
    double sum = 0;
    for (const ShellPoint& p : points) sum += double(p.area);
    return sum;
}

// The slow oracles are the trilinear field and the drawn surface.
double densityAt(const VoxelVolume& volume, const Eigen::Vector3d& p_V) {
    const Eigen::Vector3d at = p_V.cwiseQuotient(volume.spacing());
    const Eigen::Vector3i cell =
        at.array().floor().cast<int>().max(-1).min(volume.dims().array() - 1).matrix();
    const Eigen::Vector3d t = at - cell.cast<double>();
    double density = 0;
    for (int c = 0; c < 8; ++c) {
        const Eigen::Vector3i bit(c & 1, c >> 1 & 1, c >> 2 & 1);
        double weight = 1;
        for (int axis = 0; axis < 3; ++axis) weight *= bit[axis] ? t[axis] : 1 - t[axis];
        const Eigen::Vector3i voxel = cell + bit;
        density += weight * volume.at(voxel.x(), voxel.y(), voxel.z());
    }
    return density;
}

double meshArea(const VoxelVolume& volume, const LeafLattice& lattice) {
    const MeshGrid grid(volume, lattice);
    double area = 0;
    for (const NodeMesh& mesh : test::meshAll(volume, lattice)) {
        const auto corner = [&](size_t n) {
            return grid.position(grid.stepsOf(mesh.leaf, mesh.vertices[mesh.indices[n]]));
        };
        for (size_t n = 0; n < mesh.indices.size(); n += 3) {
            const Eigen::Vector3d a = corner(n);
            area += (corner(n + 1) - a).cross(corner(n + 2) - a).norm() / 2;
        }
    }
    return area;
}

// The grid has this spacing around the origin of its centre, and 20 of the largest voxels to each side.
struct Grid {
    explicit Grid(const Eigen::Vector3d& spacing) : largest(spacing.maxCoeff()) {
        geometry.spacing = spacing;
        geometry.dims = (40 * largest * spacing.cwiseInverse()).array().round().cast<int>() + 1;
        center = geometry.dims.cast<double>().cwiseProduct(spacing) / 2;
    }
    VolumeGeometry geometry;
    double largest;  // m
    Eigen::Vector3d center;
};

std::vector<Eigen::Vector3d> someSpacings() {
    std::vector<Eigen::Vector3d> spacings;
    for (const double h : {0.1e-3, 0.3e-3, 1e-3}) {
        spacings.push_back({h, h, h});
        spacings.push_back({0.5 * h, 0.8 * h, h});
    }
    return spacings;
}

// It is zero at 1 with a zero slope, so that a sum over points is as good as an integral.
double bump(double x) {
    return x * x < 1 ? (1 - x * x) * (1 - x * x) : 0;
}

template <class Weight>
double weightedArea(const std::vector<ShellPoint>& points, Weight&& weight) {
    double sum = 0;
    for (const ShellPoint& p : points) sum += double(p.area) * weight(p.position.template cast<double>());
    return sum;
}

TEST(ShellAreas, AddUpToTheSphere) {
    for (const Eigen::Vector3d& spacing : someSpacings()) {
        const Grid grid(spacing);
        const double radius = 12.3 * grid.largest;
        const VoxelVolume volume = bodyVolume(grid.geometry, sphereAt(grid.center, radius));
        const LeafLattice lattice(volume, Eigen::Vector3i::Constant(16));
        const PointShell shell(volume, lattice, {.levels = kLevels});
        for (int level = 0; level < 3; ++level)
            EXPECT_NEAR(totalArea(allPoints(shell, level, lattice)) / (4 * M_PI * radius * radius), 1, 0.02)
                << spacing.transpose() << " level " << level;
    }
}

TEST(ShellAreas, AddUpToTheCylinder) {
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    for (const Eigen::Vector3d& spacing : someSpacings()) {
        const Grid grid(spacing);
        const Eigen::Vector3d axis =
            Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
        const double radius = 9.1 * grid.largest;
        const double length = 15 * grid.largest;
        const VoxelVolume volume = bodyVolume(grid.geometry, [&](const Eigen::Vector3d& p) {
            return (p - grid.center).cross(axis).norm() - radius;
        });
        const LeafLattice lattice(volume, Eigen::Vector3i::Constant(16));
        const PointShell shell(volume, lattice, {.levels = kLevels});
        const double truth = 2 * M_PI * radius * length * 16 / 15;  // ∫ bump = 16/15
        for (int level = 0; level < 3; ++level) {
            const double area = weightedArea(allPoints(shell, level, lattice), [&](const Eigen::Vector3d& p) {
                const bool is_side = (p - grid.center).cross(axis).norm() > radius / 2;
                return is_side ? bump((p - grid.center).dot(axis) / length) : 0.0;
            });
            EXPECT_NEAR(area / truth, 1, 0.02) << spacing.transpose() << " level " << level;
        }
    }
}

TEST(ShellAreas, AddUpToAPlaneOfAnyOrientation) {
    std::mt19937 random(11);
    std::normal_distribution<double> gauss;
    std::uniform_real_distribution<double> shift(-0.5, 0.5);
    const auto spacings = someSpacings();
    for (int n = 0; n < 20; ++n) {
        const Grid grid(spacings[size_t(n) % spacings.size()]);
        const Eigen::Vector3d normal =
            Eigen::Vector3d(gauss(random), gauss(random), gauss(random)).normalized();
        const Eigen::Vector3d point = grid.center + shift(random) * grid.largest * normal;
        const double radius = 17 * grid.largest;
        const VoxelVolume volume = bodyVolume(grid.geometry, test::halfSpace(point, normal));
        const LeafLattice lattice(volume, Eigen::Vector3i::Constant(16));
        const PointShell shell(volume, lattice, {.levels = kLevels});
        for (int level = 0; level < 3; ++level) {
            const double area = weightedArea(allPoints(shell, level, lattice), [&](const Eigen::Vector3d& p) {
                return bump((p - point).norm() / radius);
            });
            EXPECT_NEAR(area / (M_PI * radius * radius / 3), 1, 0.02)
                << "normal " << normal.transpose() << " level " << level;
        }
    }
}

// The documented bounds are the projection's tolerance above the trilinear surface, and that surface's own
// error beside a sphere.
TEST(ShellPoints, LieOnTheTrilinearSurfaceAndNearTheSphere) {
    for (const ShellNormals normals : {ShellNormals::kTrilinear, ShellNormals::kCentralDifference})
        for (const Eigen::Vector3d& spacing : someSpacings()) {
            const Grid grid(spacing);
            const double h = grid.largest;
            const double radius = 12.3 * h;
            const VoxelVolume volume = bodyVolume(grid.geometry, sphereAt(grid.center, radius));
            const LeafLattice lattice(volume, Eigen::Vector3i(16, 11, 16));
            const PointShell shell(volume, lattice, {.levels = levelsOf({1, 2, 3}, normals)});
            const double counts_per_voxel = kMaxDensity / 4.0;
            const double diagonal = std::sqrt(3.0) * counts_per_voxel;  // largest |density - iso| in a cell
            for (int level = 0; level < 3; ++level) {
                const auto points = allPoints(shell, level, lattice);
                ASSERT_GT(points.size(), 0u);
                for (const ShellPoint& p : points) {
                    const Eigen::Vector3d p_V = p.position.cast<double>();
                    const Eigen::Vector3d r = p_V - grid.center;
                    ASSERT_LT(std::abs(densityAt(volume, p_V) - volume.iso()),
                              1.1 * double(kProjectionTolerance) * diagonal);
                    ASSERT_LT(std::abs(r.norm() - radius), h * h / (4 * radius) + 1e-3 * h);
                    const double cosine = std::min(1.0, p.normal.cast<double>().dot(r.normalized()));
                    const double limit_deg = normals == ShellNormals::kTrilinear ? 3.5 : 0.3;
                    ASSERT_LT(std::acos(cosine) * 180 / M_PI, limit_deg) << spacing.transpose();
                }
            }
        }
}

TEST(ShellPoints, NoiseGivesPointsOnTheSurfaceWithTheMeshsArea) {
    for (unsigned seed = 0; seed < 6; ++seed) {
        VoxelVolume volume(test::boxGeometry({19, 22, 17}), 30000);
        std::mt19937 random(seed);
        seed % 2 ? test::fillWaves(volume, random) : test::fillNoise(volume, random);
        const LeafLattice lattice(volume, {3, 4, 3});  // small leaves: the mesh's vertices are rounded less
        const PointShell shell(volume, lattice, {.levels = levelsOf({1, 2, 3}, ShellNormals(seed / 2 % 2))});
        const double expected = meshArea(volume, lattice);
        const Eigen::AlignedBox3d inside(  // away from the border's cells, their faces included
            0.01 * volume.spacing(),
            (volume.dims().cast<double>().array() - 1.01).matrix().cwiseProduct(volume.spacing()));
        for (int level = 0; level < 3; ++level) {
            const auto points = allPoints(shell, level, lattice);
            ASSERT_GT(points.size(), 100u);
            EXPECT_NEAR(totalArea(points) / expected, 1, 1e-4) << "seed " << seed << " level " << level;
            for (const ShellPoint& p : points) {
                ASSERT_TRUE(p.position.allFinite());
                ASSERT_TRUE(p.normal.isZero() || std::abs(p.normal.norm() - 1) < 1e-5f);
                ASSERT_GT(p.area, 0);
                const Eigen::Vector3d p_V = p.position.cast<double>();
                // The largest |density - iso| is the noise's own, but for cells at the border of air.
                const bool is_noise = seed % 2 == 0 && inside.exteriorDistance(p_V) == 0;
                const double largest = is_noise ? 150 : kMaxDensity;
                ASSERT_LE(std::abs(densityAt(volume, p_V) - volume.iso()),
                          1.1 * double(kProjectionTolerance) * largest);
            }
        }
    }
}

// Each point lies in its own block.
TEST(ShellPoints, KeepToTheirBlocks) {
    VoxelVolume volume(test::boxGeometry({19, 22, 17}), 30000);
    std::mt19937 random(3);
    test::fillNoise(volume, random);
    const LeafLattice lattice(volume, {7, 5, 8});
    const PointShell shell(volume, lattice, {.levels = kLevels});
    for (int level = 0; level < 3; ++level) {
        ASSERT_GT(shell.pointCount(level), 0u);
        for (LeafId leaf = 0; leaf < lattice.leafCount(); ++leaf) {
            const IndexBox cells = lattice.cellsOf(leaf);
            const int s = shell.scalingFactor(level);
            BlockKey last_key;
            for (const ShellPoint& p : pointsOf(shell, level, leaf)) {
                const Eigen::Vector3i block = p.key.index();
                const Eigen::Array3d at = p.position.cast<double>().cwiseQuotient(volume.spacing()).array() -
                                          (cells.min + s * block).cast<double>().array();
                ASSERT_TRUE((at > -1e-4).all() && (at < s + 1e-4).all()) << at.transpose();
                ASSERT_TRUE(p.key > last_key || p.key == BlockKey{});
                last_key = p.key;
            }
        }
    }
}

}  // namespace
}  // namespace bonemill
