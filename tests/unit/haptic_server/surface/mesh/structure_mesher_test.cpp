// The surfaces of labelled bodies of known shape are where the bodies' are, and have no stairs.
#include "haptic_server/surface/mesh/structure_mesher.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using Distance = std::function<double(const Vector3d&)>;

constexpr MaterialId kStructure = 2;
const Vector3d kMiddleOfBox(0.0123, 0.0118, 0.0121);

MaterialTable oneProtected() {
    MaterialTable table(3);
    table[kStructure].is_protected = true;
    return table;
}

std::vector<NodeMesh> structuresOf(const Distance& distance, const Vector3d& spacing, int edge = 60) {
    VoxelVolume volume(test::boxGeometry(Eigen::Vector3i::Constant(edge), spacing), 1000);
    const BoneProperties properties(volume, [&](const Eigen::Vector3i& voxel) {
        return distance(spacing.cwiseProduct(voxel.cast<double>())) < 0 ? kStructure : MaterialId(1);
    });
    return meshStructures(properties, oneProtected(), spacing);
}

Vector3d placeOf(const NodeMesh& mesh, const PackedVertex& v) {
    return (mesh.origin + mesh.step.cwiseProduct(Eigen::Vector3f(v.x, v.y, v.z))).cast<double>();
}

struct Deviation {
    double worst = 0, rms = 0;  // m
    double worst_angle = 0;     // rad, of the normals
};

Deviation deviationOf(const NodeMesh& mesh, const Distance& distance) {
    Deviation deviation;
    for (const uint32_t index : mesh.indices) {
        const PackedVertex& vertex = mesh.vertices[index];
        const Vector3d p = placeOf(mesh, vertex);
        Vector3d out;
        for (int axis = 0; axis < 3; ++axis)
            out[axis] = distance(p + 1e-6 * Vector3d::Unit(axis)) - distance(p - 1e-6 * Vector3d::Unit(axis));
        const Vector3d normal = decodeNormal(vertex.octahedral_u, vertex.octahedral_v).cast<double>();
        deviation.worst_angle =
            std::max(deviation.worst_angle, std::acos(std::min(1.0, normal.dot(out.normalized()))));
        deviation.worst = std::max(deviation.worst, std::abs(distance(p)));
        deviation.rms += distance(p) * distance(p);
    }
    deviation.rms = std::sqrt(deviation.rms / double(mesh.indices.size()));
    return deviation;
}

// Each edge has one triangle on either side, which go along it in opposite directions.
bool isClosed(const NodeMesh& mesh) {
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    for (size_t t = 0; t < mesh.indices.size(); t += 3)
        for (size_t i = 0; i < 3; ++i) ++edges[{mesh.indices[t + i], mesh.indices[t + (i + 1) % 3]}];
    return std::ranges::all_of(edges, [&](const auto& edge) {
        const auto back = edges.find({edge.first.second, edge.first.first});
        return edge.second == 1 && back != edges.end();
    });
}

Distance ballOf(double radius) {
    return [=](const Vector3d& p) { return (p - kMiddleOfBox).norm() - radius; };
}

// An oblique tube with rounded ends.
Distance tubeOf(double radius) {
    return [=](const Vector3d& p) {
        const Vector3d along = Vector3d(1, 0.62, 0.37).normalized(), r = p - kMiddleOfBox;
        return (r - std::clamp(r.dot(along), -0.006, 0.006) * along).norm() - radius;
    };
}

void expectNear(const Distance& distance, const Vector3d& spacing, double worst, double rms,
                double worst_angle_deg) {
    const auto meshes = structuresOf(distance, spacing);
    ASSERT_EQ(meshes.size(), 1u);
    EXPECT_EQ(meshes[0].leaf, kStructure);
    EXPECT_TRUE(isClosed(meshes[0]));
    EXPECT_LE(meshes[0].indices.size() / 3, kMaxStructureTriangles);
    const Deviation deviation = deviationOf(meshes[0], distance);
    const double voxel = spacing.maxCoeff();
    EXPECT_LT(deviation.worst / voxel, worst);
    EXPECT_LT(deviation.rms / voxel, rms);
    EXPECT_LT(deviation.worst_angle * 180 / M_PI, worst_angle_deg);
}

TEST(StructureMesher, ABallIsABall) {
    expectNear(ballOf(0.006), Vector3d::Constant(4e-4), 0.35, 0.11, 12);
}

TEST(StructureMesher, ANerveOfThreeVoxelsIsATube) {
    expectNear(tubeOf(6e-4), Vector3d::Constant(4e-4), 0.7, 0.22, 40);
}

TEST(StructureMesher, VoxelsThatAreNoCubesDoNotMatter) {
    expectNear(ballOf(0.006), Vector3d(3e-4, 4e-4, 6e-4), 0.5, 0.1, 26);
}

TEST(StructureMesher, ALargeOneHasFewTriangles) {
    const Distance ball = [](const Vector3d& p) { return (p - Vector3d::Constant(0.03)).norm() - 0.0285; };
    const auto meshes = structuresOf(ball, Vector3d::Constant(4e-4), 150);
    ASSERT_EQ(meshes.size(), 1u);
    EXPECT_LE(meshes[0].indices.size() / 3, kMaxStructureTriangles);
    EXPECT_LT(deviationOf(meshes[0], ball).worst, 2e-4);
}

TEST(StructureMesher, OnlyWhatIsProtectedAndThereIsMeshed) {
    EXPECT_TRUE(structuresOf([](const Vector3d&) { return 1.0; }, Vector3d::Constant(4e-4)).empty());
    // All of the volume is of it: the surface closes along the volume's border.
    const auto meshes = structuresOf([](const Vector3d&) { return -1.0; }, Vector3d::Constant(4e-4), 12);
    ASSERT_EQ(meshes.size(), 1u);
    EXPECT_TRUE(isClosed(meshes[0]));
}

// A ball that was labelled on voxels of 1.25 mm, looked at on voxels of 0.25 mm: the surface is round,
// although its voxels have the stairs of the labels.
TEST(StructureMesher, LabelsOfCoarseVoxelsHaveNoStairsOnFineOnes) {
    const Vector3d fine = Vector3d::Constant(0.25e-3);
    const Distance ball = ballOf(5e-3);
    const Distance labelled = [&](const Vector3d& p) {
        constexpr double kEdge = 1.25e-3;  // five fine ones
        return ball((p / kEdge).array().round().matrix() * kEdge);
    };
    VoxelVolume volume(test::boxGeometry(Eigen::Vector3i::Constant(96), fine), 1000);
    const BoneProperties properties(volume, [&](const Eigen::Vector3i& voxel) {
        return labelled(fine.cwiseProduct(voxel.cast<double>())) < 0 ? kStructure : MaterialId(1);
    });
    const auto smooth = meshStructures(properties, oneProtected(), fine, 1.25e-3);
    ASSERT_EQ(smooth.size(), 1u);
    EXPECT_TRUE(isClosed(smooth[0]));
    const Deviation here = deviationOf(smooth[0], ball);
    const Deviation stairs = deviationOf(meshStructures(properties, oneProtected(), fine)[0], ball);
    const Deviation coarse = deviationOf(structuresOf(ball, Vector3d::Constant(1.25e-3), 24)[0], ball);
    EXPECT_LT(here.rms, 1.5 * coarse.rms);
    EXPECT_LT(here.rms, 0.5 * stairs.rms);
    EXPECT_LT(here.worst_angle, 0.4 * stairs.worst_angle);
}

double volumeOf(const NodeMesh& mesh) {
    double volume = 0;
    for (size_t t = 0; t < mesh.indices.size(); t += 3) {
        const auto corner = [&](size_t n) { return placeOf(mesh, mesh.vertices[mesh.indices[t + n]]); };
        volume += corner(0).dot(corner(1).cross(corner(2))) / 6;
    }
    return volume;
}

// Smoothing would shrink it to a line.
TEST(StructureMesher, ANerveOfOneLabelsThicknessIsStillThere) {
    const Vector3d fine = Vector3d::Constant(0.25e-3);
    VoxelVolume volume(test::boxGeometry(Eigen::Vector3i(64, 24, 24), fine), 1000);
    const BoneProperties properties(volume, [&](const Eigen::Vector3i& v) {
        const bool is_nerve = (v.array() >= 8).all() && v.x() < 56 && v.y() < 12 && v.z() < 12;
        return is_nerve ? kStructure : MaterialId(1);
    });
    const auto meshes = meshStructures(properties, oneProtected(), fine, 1e-3);
    ASSERT_EQ(meshes.size(), 1u);
    EXPECT_NEAR(volumeOf(meshes[0]), 12e-9, 0.02 * 12e-9);
}

}  // namespace
}  // namespace bonemill
