// The surface of a bone whose region has fine voxels, across the region's border, from a scan's file on.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "haptic_server/scene/setup/scanned_bone.h"
#include "haptic_server/surface/mesh/leaf_mesher.h"
#include "haptic_server/surface/mesh/surroundings_mesher.h"
#include "tests/support/joined_surface.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/write_nrrd.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using test::JoinedSurface;

constexpr double kMm = 1e-3;

struct Body {
    const char* name;
    double (*distance)(const Vector3d& p_W);  // m; negative inside
};

double distanceToBall(const Vector3d& p) {
    return (p - Vector3d(17, 15, 16) * kMm).norm() - 10.3 * kMm;
}
double distanceToCylinder(const Vector3d& p) {
    const Vector3d along = Vector3d(1, 0.4, 0.3).normalized(), from = p - Vector3d(17, 15, 16) * kMm;
    return (from - from.dot(along) * along).norm() - 6.1 * kMm;
}
double distanceToPlate(const Vector3d& p) {
    return std::abs((p - Vector3d(17, 15, 16) * kMm).dot(Vector3d(0.2, 0.3, 1).normalized())) - 2.2 * kMm;
}
constexpr Body kBodies[] = {
    {"ball", distanceToBall}, {"cylinder", distanceToCylinder}, {"plate", distanceToPlate}};
constexpr double kMostDegrees = 5;

const std::string kBox = "min_mm { x: 9.4 y: 7.3 z: 9.8 } max_mm { x: 23.8 y: 21.9 z: 22 } ";
const std::string kRegion = kBox + "resample_mm: 0.3";  // its faces all lie between the scan's voxels

// A scan with voxels of 1 x 1 x 1.5 mm.
ScannedBone scanned(const test::TemporaryFolder& folder, const Body& body,
                    const std::string& region = kRegion) {
    VolumeGeometry geometry;
    geometry.dims = {34, 31, 22};
    geometry.spacing = Vector3d(1, 1, 1.5) * kMm;
    geometry.X_WV.position = Vector3d(0.2, 0.1, -0.3) * kMm;
    std::vector<float> values;
    forEachIndex({Eigen::Vector3i::Zero(), geometry.dims.array() - 1}, [&](const Eigen::Vector3i& v) {
        const double d =
            body.distance(geometry.X_WV * Vector3d(geometry.spacing.cwiseProduct(v.cast<double>())));
        values.push_back(float(500 - 1000 * std::tanh(d / (1.5 * kMm))));
    });
    writeNrrd(folder / "scan.nrrd", geometry, values);
    std::ofstream(folder / "s.textproto")
        << "volume { path: 'scan.nrrd' iso_value: 500 window_low: -600 window_high: 1600 region { " << region
        << " } }\n";
    return readBone(loadScene(folder / "s.textproto"));
}

std::vector<NodeMesh> meshesAround(const ScannedBone& bone) {
    std::vector<NodeMesh> meshes;
    meshSurroundings(*bone.surroundings, 0, {}, [&](NodeMesh&& mesh) {
        meshes.push_back(std::move(mesh));
        return true;
    });
    return meshes;
}

std::vector<NodeMesh> meshesOfRegion(const ScannedBone& bone) {
    const LeafLattice lattice(bone.volume, Eigen::Vector3i::Constant(16));
    LeafMesher mesher(bone.volume, lattice, MeshGrid::kStreamedStepsPerCell, {}, &bone.surroundings->rim);
    std::vector<NodeMesh> meshes;
    for (LeafId leaf = 0; leaf < lattice.leafCount(); ++leaf) meshes.push_back(mesher.mesh(leaf).value());
    return meshes;
}

std::vector<NodeMesh> allMeshes(const ScannedBone& bone) {
    std::vector<NodeMesh> meshes = meshesOfRegion(bone);
    for (NodeMesh& mesh : meshesAround(bone)) meshes.push_back(std::move(mesh));
    return meshes;
}

// Of the region's box: 0 on its faces, negative inside.
double distanceToFaces(const ScannedBone& bone, const Vector3d& p_V) {
    const Vector3d end =
        bone.volume.spacing().cwiseProduct((bone.volume.dims().array() - 1).matrix().cast<double>());
    return (-p_V).cwiseMax(p_V - end).maxCoeff();
}

struct Worst {
    double off = 0, degrees = 0;  // m beside the body's surface, and of normals
    size_t vertices = 0;
};

// Of the vertices within 2 mm of the region's faces.
Worst worstAtBorder(const ScannedBone& bone, const Body& body) {
    Worst worst;
    const auto distance = [&](const Vector3d& p_V) {
        return body.distance(bone.volume.geometry().X_WV * p_V);
    };
    for (const NodeMesh& mesh : allMeshes(bone))
        for (size_t n = 0; n < mesh.vertices.size(); ++n) {
            const Vector3d p = test::vertexPlace(mesh, n);
            if (std::abs(distanceToFaces(bone, p)) > 2 * kMm) continue;
            Vector3d slope;
            for (int axis = 0; axis < 3; ++axis) {
                const Vector3d step = 1e-6 * Vector3d::Unit(axis);
                slope[axis] = distance(p + step) - distance(p - step);
            }
            worst.off = std::max(worst.off, std::abs(distance(p)));
            worst.degrees = std::max(worst.degrees, test::degreesBetween(slope, test::vertexNormal(mesh, n)));
            ++worst.vertices;
        }
    return worst;
}

class RegionBorder : public testing::Test {
  protected:
    test::TemporaryFolder folder_;
};

TEST_F(RegionBorder, IsClosedAndSmooth) {
    for (const Body& body : kBodies) {
        SCOPED_TRACE(body.name);
        const ScannedBone bone = scanned(folder_, body);
        const JoinedSurface surface(allMeshes(bone));
        EXPECT_EQ(surface.openEdges(), 0u);
        EXPECT_LE(surface.largestJump(), kMostDegrees);
        const Worst worst = worstAtBorder(bone, body);
        EXPECT_LE(worst.degrees, kMostDegrees);
        EXPECT_LE(worst.off, 0.1 * kMm);
        EXPECT_GT(worst.vertices, 1000u);
        RecordProperty(std::string(body.name) + "_jump_deg", std::to_string(surface.largestJump()));
        RecordProperty(std::string(body.name) + "_normal_deg", std::to_string(worst.degrees));
        RecordProperty(std::string(body.name) + "_off_mm", std::to_string(worst.off / kMm));
    }
}

// What is taken away up to the faces and the edges of the region, the whole region at last, leaves walls.
TEST_F(RegionBorder, StaysClosedHoweverItIsMilled) {
    for (const Body& body : kBodies) {
        SCOPED_TRACE(body.name);
        ScannedBone bone = scanned(folder_, body);
        const std::vector<NodeMesh> around = meshesAround(bone);
        const Eigen::Vector3i dims = bone.volume.dims();
        for (const double radius : {8.0, 20.0, 1000.0}) {  // voxels
            size_t cleared = 0;
            forEachIndex({Eigen::Vector3i::Zero(), dims.array() - 1}, [&](const Eigen::Vector3i& v) {
                for (const Eigen::Vector3i& at : {Eigen::Vector3i(0, dims.y() / 2, dims.z() / 2),
                                                  Eigen::Vector3i(dims.x(), dims.y(), dims.z() / 2)})
                    if ((v - at).cast<double>().norm() < radius) {
                        cleared += bone.volume.at(v.x(), v.y(), v.z()) >= bone.volume.iso();
                        bone.volume.set(v.x(), v.y(), v.z(), 0);
                    }
            });
            EXPECT_GT(cleared, 0u);
            std::vector<NodeMesh> meshes = meshesOfRegion(bone);
            meshes.insert(meshes.end(), around.begin(), around.end());
            EXPECT_EQ(JoinedSurface(meshes).openEdges(), 0u);
        }
    }
}

// Voxels of the region that are larger than the scan's, a box of hardly more than one of the scan's voxels,
// or one that reaches beyond the scan.
TEST_F(RegionBorder, IsClosedWhateverTheVoxels) {
    const std::string regions[] = {
        kBox + "resample_mm: 2.3",
        "min_mm { x: 6.3 y: 14.1 z: 15 } max_mm { x: 7.9 y: 15.7 z: 17 } resample_mm: 0.4",
        "min_mm { x: -9 y: -9 z: -9 } max_mm { x: 20 y: 20 z: 90 } resample_mm: 0.7",
        kRegion + " deblur_mm: 0.4"};
    for (const std::string& region : regions) {
        SCOPED_TRACE(region);
        EXPECT_EQ(JoinedSurface(allMeshes(scanned(folder_, kBodies[0], region))).openEdges(), 0u);
        EXPECT_EQ(JoinedSurface(allMeshes(scanned(folder_, kBodies[1], region))).openEdges(), 0u);
    }
}

TEST_F(RegionBorder, OfTheShippedMastoidIsClosed) {
    const LoadedScene scene = loadScene(test::sourceDir() + "/deploy/scenes/mastoid.textproto");
    if (!std::filesystem::exists(resolvePath(scene, scene.scene.volume().path())) ||
        !std::filesystem::exists(resolvePath(scene, scene.scene.volume().label_path())))
        GTEST_SKIP() << "the scan of mastoid.textproto is not there";
    const JoinedSurface surface(allMeshes(readBone(scene)));
    EXPECT_EQ(surface.openEdges(), 0u);
    EXPECT_LE(surface.largestJump(), kMostDegrees);
    EXPECT_GT(surface.shared(), 1000u);
    RecordProperty("jump_deg", std::to_string(surface.largestJump()));
}

}  // namespace
}  // namespace bonemill
