#include "haptic_server/surface/mesh/leaf_mesher.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <numbers>

#include "haptic_server/surface/mesh/mesh_check.h"
#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

using test::boxGeometry;
using test::forEachVoxel;
using test::meshAll;

constexpr Density kIso = 32768;

// There are cubes, non-cubes, single cells, leaves cut by the far border, and one leaf for all.
const std::vector<Eigen::Vector3i> kLeafSizes = {{16, 16, 16}, {4, 4, 4},  {5, 7, 3},
                                                 {1, 1, 1},    {9, 2, 31}, {200, 200, 200}};

using Fill = std::function<void(VoxelVolume&)>;

void expectClosed(const char* what, const Eigen::Vector3i& dims, const Fill& fill) {
    VoxelVolume volume(boxGeometry(dims), kIso);
    fill(volume);
    for (const Eigen::Vector3i& leaf_cells : kLeafSizes) {
        const LeafLattice lattice(volume, leaf_cells);
        const std::vector<NodeMesh> meshes = meshAll(volume, lattice);
        const MeshCheck check = checkMesh(meshes, MeshGrid(volume, lattice));
        EXPECT_TRUE(check.isClosed())
            << what << ", leaf of " << leaf_cells.transpose() << " cells: " << check.open_edges << " open, "
            << check.crowded_edges << " crowded, " << check.misoriented_edges << " misoriented edges";
        EXPECT_GT(check.triangles, 0u) << what;
        EXPECT_GT(check.volume, 0) << what;
    }
}

TEST(LeafMesher, ClosedOnNoise) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
        std::mt19937 random(seed);
        expectClosed("noise", {20, 17, 23}, [&](VoxelVolume& v) { test::fillNoise(v, random); });
    }
}

TEST(LeafMesher, ClosedOnWaves) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
        std::mt19937 random(seed);
        expectClosed("waves", {31, 33, 16}, [&](VoxelVolume& v) { test::fillWaves(v, random); });
    }
}

TEST(LeafMesher, ClosedAroundSingleVoxels) {
    for (const Density density : {kIso, Density(kIso + 1), kMaxDensity})
        for (const Eigen::Vector3i& voxel :
             {Eigen::Vector3i(0, 0, 0), Eigen::Vector3i(8, 8, 8), Eigen::Vector3i(3, 15, 7)})
            expectClosed("one voxel", {9, 16, 9},
                         [&](VoxelVolume& v) { v.set(voxel.x(), voxel.y(), voxel.z(), density); });
}

TEST(LeafMesher, ClosedWhenTheBoneFillsTheVolume) {
    for (const Density density : {kIso, kMaxDensity})
        expectClosed("full", {17, 8, 5}, [&](VoxelVolume& v) {
            forEachVoxel(test::wholeBox(v), [&](int i, int j, int k) { v.set(i, j, k, density); });
        });
}

TEST(LeafMesher, ClosedWhenDensitiesEqualIso) {
    std::mt19937 random(7);
    std::bernoulli_distribution coin;
    expectClosed("iso or just below", {16, 16, 16}, [&](VoxelVolume& v) {
        forEachVoxel(test::wholeBox(v),
                     [&](int i, int j, int k) { v.set(i, j, k, Density(coin(random) ? kIso : kIso - 1)); });
    });
}

TEST(LeafMesher, ClosedOnTheSmallestVolume) {
    expectClosed("1 voxel", {1, 1, 1}, [](VoxelVolume& v) { v.set(0, 0, 0, kMaxDensity); });
}

TEST(LeafMesher, ClosedAtExtremeIsoValues) {
    for (const Density iso : {Density(1), kMaxDensity}) {
        VoxelVolume volume(boxGeometry({12, 12, 12}), iso);
        std::mt19937 random(3);
        std::uniform_int_distribution<int> any(0, 3);
        forEachVoxel(test::wholeBox(volume), [&](int i, int j, int k) {
            constexpr std::array<Density, 4> kValues = {0, 1, kMaxDensity - 1, kMaxDensity};
            volume.set(i, j, k, kValues[size_t(any(random))]);
        });
        const LeafLattice lattice(volume, {5, 5, 5});
        const std::vector<NodeMesh> meshes = meshAll(volume, lattice);
        ASSERT_GT(meshes.size(), 0u);
        EXPECT_TRUE(checkMesh(meshes, MeshGrid(volume, lattice)).isClosed());
    }
}

TEST(LeafMesher, LeavesShareBitIdenticalVertices) {
    std::mt19937 random(11);
    VoxelVolume volume(boxGeometry({20, 20, 20}), kIso);
    test::fillWaves(volume, random);
    const LeafLattice lattice(volume, {4, 5, 3});
    const MeshGrid grid(volume, lattice);
    const BoneProperties properties = test::stripedProperties(volume);
    std::map<std::array<int, 3>, std::array<int, 3>> look_at;
    size_t shared = 0;
    for (const NodeMesh& mesh : meshAll(volume, lattice, &properties))
        for (size_t n = 0; n < mesh.vertices.size(); ++n) {
            const PackedVertex& v = mesh.vertices[n];
            const Eigen::Vector3i s = grid.stepsOf(mesh.leaf, v);
            const int material = mesh.materials.empty() ? 0 : mesh.materials[n];
            const std::array<int, 3> look = {v.octahedral_u, v.octahedral_v, material};
            const auto [entry, is_new] = look_at.try_emplace({s.x(), s.y(), s.z()}, look);
            EXPECT_EQ(entry->second, look);
            if (!is_new) ++shared;
        }
    EXPECT_GT(shared, 100u);
}

// The material goes by density, as a scene says it: the outermost voxels are only partly filled and would be
// of the softer one.
TEST(LeafMesher, AVoxelThatIsPartlyFilledLooksAsTheBoneBelowIt) {
    constexpr MaterialId kSoft = 1, kHard = 2;
    constexpr double kRadius = 7.3;
    VoxelVolume volume(boxGeometry({20, 20, 20}, Eigen::Vector3d::Constant(5e-4)), kIso);
    forEachVoxel(test::wholeBox(volume), [&](int i, int j, int k) {
        const double depth = kRadius - (Eigen::Vector3d(i, j, k).array() - 9.6).matrix().norm();
        volume.set(i, j, k, Density(std::clamp(kIso + 40000 * depth, 0.0, 60000.0)));
    });
    const auto material = [&](const Eigen::Vector3i& v) {
        return volume.at(v.x(), v.y(), v.z()) > 55000 ? kHard : kSoft;
    };
    const BoneProperties properties(volume, material);
    const LeafLattice lattice(volume, {6, 6, 6});
    size_t hard = 0, all = 0;
    for (const NodeMesh& mesh : meshAll(volume, lattice, &properties)) {
        ASSERT_EQ(mesh.materials.size(), mesh.vertices.size());
        hard += size_t(std::ranges::count(mesh.materials, kHard));
        all += mesh.vertices.size();
    }
    ASSERT_GT(all, 0u);
    EXPECT_EQ(hard, all);
}

// A cut through layers shows each where it is; what was never bone has none.
TEST(LeafMesher, ACutShowsTheLayersBelow) {
    VoxelVolume volume(boxGeometry({24, 24, 24}), kIso);
    forEachVoxel({{4, 4, 4}, {19, 19, 19}}, [&](int i, int j, int k) { volume.set(i, j, k, kMaxDensity); });
    const BoneProperties properties(volume, [&](const Eigen::Vector3i& v) {
        if (volume.at(v.x(), v.y(), v.z()) == 0) return kNoMaterial;
        return MaterialId(v.x() < 12 ? 1 : 2);
    });
    // The upper half is milled away, and something was added: in the gap, and where nothing ever was.
    forEachVoxel({{4, 4, 12}, {19, 19, 19}}, [&](int i, int j, int k) { volume.set(i, j, k, 0); });
    forEachVoxel({{4, 4, 12}, {6, 19, 14}}, [&](int i, int j, int k) { volume.set(i, j, k, kMaxDensity); });
    forEachVoxel({{20, 4, 4}, {22, 19, 8}}, [&](int i, int j, int k) { volume.set(i, j, k, kMaxDensity); });
    const LeafLattice lattice(volume, {7, 7, 7});
    const MeshGrid grid(volume, lattice);
    size_t seen[3] = {};
    for (const NodeMesh& mesh : meshAll(volume, lattice, &properties))
        for (size_t n = 0; n < mesh.vertices.size(); ++n) {
            const Eigen::Vector3d at =
                grid.stepsOf(mesh.leaf, mesh.vertices[n]).cast<double>() / grid.stepsPerCell();
            const int expected = at.x() < 11.5 ? 1 : at.x() < 20 ? 2 : 0;
            const bool is_at_border = std::abs(at.x() - 11.5) < 1.01 || std::abs(at.x() - 19.5) < 1.01;
            const int material = mesh.materials.empty() ? 0 : mesh.materials[n];
            if (is_at_border) continue;
            EXPECT_EQ(material, expected) << at.transpose();
            ++seen[material];
        }
    for (const size_t count : seen) EXPECT_GT(count, 100u);
}

// The oracle walks every grid edge of the volume; each crossed one must carry exactly one vertex, where
// interpolation says.
TEST(LeafMesher, OneVertexOnEachCrossedGridEdgeWhereInterpolationPutsIt) {
    std::mt19937 random(5);
    VoxelVolume volume(boxGeometry({15, 12, 18}), kIso);
    test::fillNoise(volume, random);
    const LeafLattice lattice(volume, {8, 8, 8});
    const MeshGrid grid(volume, lattice);
    const double q = grid.stepsPerCell();
    std::map<std::array<int, 4>, double> expected;  // low voxel and axis -> fraction of the cell
    const Eigen::Vector3i& dims = volume.dims();
    forEachVoxel({Eigen::Vector3i::Constant(-1), dims}, [&](int i, int j, int k) {
        const Eigen::Vector3i low(i, j, k);
        for (int axis = 0; axis < 3; ++axis) {
            const Eigen::Vector3i high = low + Eigen::Vector3i::Unit(axis);
            if (high[axis] > dims[axis]) continue;
            const double a = volume.at(i, j, k);
            const double b = volume.at(high.x(), high.y(), high.z());
            if ((a >= kIso) == (b >= kIso)) continue;
            expected[{i, j, k, axis}] = std::clamp((kIso - a) / (b - a), 1 / q, 1 - 1 / q);
        }
    });

    std::map<std::array<int, 4>, double> found;
    for (const NodeMesh& mesh : meshAll(volume, lattice))
        for (const PackedVertex& v : mesh.vertices) {
            const Eigen::Vector3i s = grid.stepsOf(mesh.leaf, v);
            const Eigen::Array3d cell = (s.cast<double>() / q).array();
            const Eigen::Array3d fraction = cell - cell.floor();
            int axis = -1;
            ASSERT_EQ((fraction > 0).count(), 1) << "a vertex lies inside exactly one grid edge";
            fraction.maxCoeff(&axis);
            found[{int(std::floor(cell.x())), int(std::floor(cell.y())), int(std::floor(cell.z())), axis}] =
                fraction[axis];
        }
    ASSERT_GT(expected.size(), 0u);
    ASSERT_EQ(found.size(), expected.size());
    for (const auto& [edge, fraction] : expected) {
        ASSERT_TRUE(found.contains(edge));
        EXPECT_NEAR(found[edge], fraction, 0.5000001 / q);
    }
}

VoxelVolume sphereVolume(const Eigen::Vector3d& center, double radius) {
    VoxelVolume volume(boxGeometry({60, 48, 36}), kIso);
    forEachVoxel(test::wholeBox(volume), [&](int i, int j, int k) {
        const double distance =
            (volume.spacing().cwiseProduct(Eigen::Vector3d(i, j, k)) - center).norm() - radius;
        volume.set(i, j, k, Density(std::lround(std::clamp(kIso - distance * 2e7, 0.0, 65535.0))));
    });
    return volume;
}

TEST(LeafMesher, SphereHasItsVolumeAndOutwardNormals) {
    const Eigen::Vector3d center(0.0119, 0.0121, 0.0125);
    const double radius = 0.010;
    const VoxelVolume volume = sphereVolume(center, radius);
    const LeafLattice lattice(volume, {16, 16, 16});
    const MeshGrid grid(volume, lattice);
    const std::vector<NodeMesh> meshes = meshAll(volume, lattice);
    const MeshCheck check = checkMesh(meshes, grid);
    const double exact = 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3);
    EXPECT_TRUE(check.isClosed());
    EXPECT_NEAR(check.volume, exact, 0.01 * exact);

    for (const NodeMesh& mesh : meshes)
        for (const PackedVertex& v : mesh.vertices) {
            const Eigen::Vector3d p =
                (mesh.origin + mesh.step.cwiseProduct(Eigen::Vector3f(v.x, v.y, v.z))).cast<double>();
            const Eigen::Vector3d outward = (p - center).normalized();
            EXPECT_NEAR((p - center).norm(), radius, 0.02 * volume.spacing().maxCoeff());
            EXPECT_GT(decodeNormal(v.octahedral_u, v.octahedral_v).cast<double>().dot(outward), 0.998);
        }
}

TEST(LeafMesher, LeafPositionsAgreeWithTheIntegerGrid) {
    const VoxelVolume volume = sphereVolume({0.012, 0.012, 0.012}, 0.008);
    const LeafLattice lattice(volume, {7, 8, 9});
    const MeshGrid grid(volume, lattice);
    EXPECT_EQ(grid.stepsPerCell(), 65535 / 9);
    size_t vertices = 0;
    for (const NodeMesh& mesh : meshAll(volume, lattice))
        for (const PackedVertex& v : mesh.vertices) {
            ++vertices;
            const Eigen::Vector3d p =
                (mesh.origin + mesh.step.cwiseProduct(Eigen::Vector3f(v.x, v.y, v.z))).cast<double>();
            EXPECT_LT((p - grid.position(grid.stepsOf(mesh.leaf, v))).norm(), 1e-8);
        }
    ASSERT_GT(vertices, 0u);
}

TEST(LeafMesher, NormalWithoutGradientPointsOutOfTheBone) {
    VoxelVolume volume(boxGeometry({5, 5, 5}), kMaxDensity);
    volume.set(2, 2, 2,
               kMaxDensity);  // symmetric: the gradient at the voxel is zero, and the vertices sit on it
    const LeafLattice lattice(volume, {16, 16, 16});
    const NodeMesh mesh = LeafMesher(volume, lattice).mesh(0).value();
    ASSERT_EQ(mesh.vertices.size(), 6u);
    const Eigen::Vector3f middle = volume.spacing().cast<float>() * 2;
    for (const PackedVertex& v : mesh.vertices) {
        const Eigen::Vector3f p = mesh.origin + mesh.step.cwiseProduct(Eigen::Vector3f(v.x, v.y, v.z));
        EXPECT_GT(decodeNormal(v.octahedral_u, v.octahedral_v).dot((p - middle).normalized()), 0.999f);
    }
}

TEST(LeafMesher, FlatFieldGivesFiniteNormals) {
    VoxelVolume volume(boxGeometry({8, 8, 8}), kIso);
    forEachVoxel(test::wholeBox(volume),
                 [&](int i, int j, int k) { volume.set(i, j, k, i % 2 == 0 ? kMaxDensity : 0); });
    const LeafLattice lattice(volume, {4, 4, 4});
    size_t vertices = 0;
    for (const NodeMesh& mesh : meshAll(volume, lattice))
        for (const PackedVertex& v : mesh.vertices) {
            ++vertices;
            EXPECT_NEAR(decodeNormal(v.octahedral_u, v.octahedral_v).norm(), 1, 1e-5);
        }
    ASSERT_GT(vertices, 0u);
}

TEST(LeafMesher, HomogeneousLeafIsEmpty) {
    VoxelVolume volume(boxGeometry({40, 40, 40}), kIso);
    volume.set(2, 2, 2, kMaxDensity);
    const LeafLattice lattice(volume, {16, 16, 16});
    EXPECT_FALSE(LeafMesher(volume, lattice).mesh(0).value().isEmpty());
    EXPECT_TRUE(LeafMesher(volume, lattice).mesh(lattice.leafCount() - 1).value().isEmpty());
}

TEST(MeshGrid, RefusesLeavesThatSixteenBitsCannotHold) {
    const VoxelVolume volume(boxGeometry({2, 2, 2}), kIso);
    const LeafLattice fits(volume, {21845, 1, 1});
    EXPECT_EQ(MeshGrid(volume, fits).stepsPerCell(), 3);
    const LeafLattice too_large(volume, {1, 21846, 1});
    EXPECT_THROW(MeshGrid(volume, too_large), std::invalid_argument);
}

}  // namespace
}  // namespace bonemill
