// How quickly the drawn colour of bone changes along its surface: no faster than a scanner sees. Stripes of
// two materials that alternate from voxel to voxel are many and sudden changes.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <unordered_map>

#include "haptic_server/scene/setup/scene_setup.h"
#include "haptic_server/server/session/shown_shades.h"
#include "haptic_server/surface/mesh/leaf_mesher.h"
#include "tests/support/joined_surface.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/write_nrrd.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr double kChange = 0.5;    // of the way from one material's colour to the next one's
constexpr double kSameSide = 0.5;  // cosine between two normals of one side of a wall
constexpr size_t kLooked = 4000;   // vertices

struct Seen {
    Vector3d place, normal;  // V
    double shade;            // 0 to 1
};

std::vector<Seen> shadedVertices(const LoadedScene& loaded, const SceneSetup& simulation) {
    ShownBone shown(loaded.scene, simulation, simulation.bone->volume);
    const VertexLook look = shown.look();
    if (!look.shade) return {};
    const ShadeScale& scale = look.shade->scale();
    const BoneModel& bone = *simulation.bone;
    const RegionRim* const rim = simulation.surroundings ? &simulation.surroundings->rim : nullptr;
    LeafMesher mesher(bone.volume, bone.lattice, MeshGrid::kStreamedStepsPerCell, look, rim);
    std::vector<Seen> seen;
    for (LeafId leaf = 0; leaf < bone.lattice.leafCount(); ++leaf) {
        const std::optional<NodeMesh> mesh = mesher.mesh(leaf);
        if (!mesh) continue;
        for (size_t n = 0; n < mesh->vertices.size() && n < mesh->materials.size(); ++n) {
            const int number = (mesh->materials[n] & ~kMilledBit) - scale.first;
            if (number < 0 || number >= scale.count) continue;
            seen.push_back({test::vertexPlace(*mesh, n), test::vertexNormal(*mesh, n),
                            double(number) / (scale.count - 1)});
        }
    }
    return seen;
}

// The share of the vertices that have a neighbour of quite another colour within one voxel of the scan.
double shareOfChange(const std::vector<Seen>& seen, double voxel) {
    const auto keyOf = [voxel](const Vector3d& p, int x, int y, int z) {
        const Eigen::Array3d cell = (p / voxel).array().floor() + Eigen::Array3d(x, y, z);
        return (int64_t(cell.x()) * 73856093) ^ (int64_t(cell.y()) * 19349663) ^
               (int64_t(cell.z()) * 83492791);
    };
    std::unordered_multimap<int64_t, const Seen*> cells;
    for (const Seen& one : seen) cells.emplace(keyOf(one.place, 0, 0, 0), &one);
    const auto hasChange = [&](const Seen& one) {
        for (int n = 0; n < 27; ++n) {
            const auto [from, to] = cells.equal_range(keyOf(one.place, n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
            for (auto near = from; near != to; ++near) {
                const Seen& other = *near->second;
                if ((other.place - one.place).norm() <= voxel && other.normal.dot(one.normal) > kSameSide &&
                    std::abs(other.shade - one.shade) > kChange)
                    return true;
            }
        }
        return false;
    };
    size_t changes = 0, looked = 0;
    for (size_t n = 0; n < seen.size(); n += std::max<size_t>(1, seen.size() / kLooked), ++looked)
        changes += hasChange(seen[n]);
    return double(changes) / double(looked);
}

constexpr const char* kMaterials =
    "material { name: 'cells' from_value: 300 below_value: 800 color { red: 0.5 green: 1 blue: 0 } }\n"
    "material { name: 'cortex' from_value: 800 color { red: 1 green: 0.5 blue: 0 } }\n";

// A body of cortex with noise, whose surface a scanner blurs into values that single voxels of cells have.
LoadedScene scannedBody(const test::TemporaryFolder& folder, double (*distance)(const Vector3d& p)) {
    VolumeGeometry geometry;
    geometry.dims = {30, 30, 24};
    geometry.spacing = Vector3d(1, 1, 1.5) * 1e-3;
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0, 40);
    std::vector<float> values;
    forEachIndex({Eigen::Vector3i::Zero(), geometry.dims.array() - 1}, [&](const Eigen::Vector3i& v) {
        const double d = distance(geometry.spacing.cwiseProduct(v.cast<double>()));
        values.push_back(float(150 - 1050 * std::tanh(d / 0.8e-3) + noise(random)));
    });
    writeNrrd(folder / "scan.nrrd", geometry, values);
    std::ofstream(folder / "s.textproto")
        << "volume { path: 'scan.nrrd' iso_value: 300 window_low: -1000 window_high: 2000 }\n"
        << kMaterials << "effects { bleeding { material: 'cells' } }\n";
    return loadScene(folder / "s.textproto");
}

double ofBody(double (*distance)(const Vector3d& p)) {
    const test::TemporaryFolder folder;
    const LoadedScene loaded = scannedBody(folder, distance);
    const SceneSetup simulation = setUpScene(loaded);
    const std::vector<Seen> seen = shadedVertices(loaded, simulation);
    EXPECT_GT(seen.size(), 1000u);
    return shareOfChange(seen, 1e-3);
}

TEST(ShadeChange, ABallHasOneColour) {
    EXPECT_EQ(ofBody([](const Vector3d& p) { return (p - Vector3d(15, 15, 17) * 1e-3).norm() - 9.2e-3; }), 0);
}

TEST(ShadeChange, ACylinderHasOneColour) {
    EXPECT_EQ(ofBody([](const Vector3d& p) {
                  const Vector3d along = Vector3d(1, 0.4, 0.3).normalized(),
                                 from = p - Vector3d(15, 15, 17) * 1e-3;
                  return (from - from.dot(along) * along).norm() - 6.1e-3;
              }),
              0);
}

TEST(ShadeChange, StripesWouldBeSeen) {
    std::vector<Seen> striped;
    for (int n = 0; n < 100; ++n)
        for (int m = 0; m < 100; ++m)
            striped.push_back({Vector3d(n, m, 0) * 2e-4, Vector3d::UnitZ(), n / 5 % 2 == 0 ? 0.1 : 0.9});
    EXPECT_GT(shareOfChange(striped, 1e-3), 0.9);
}

TEST(ShadeChange, TheMastoidOfARealHeadHasNoStripes) {
    const std::filesystem::path scene = test::sourceDir() + "/deploy/scenes/mastoid.textproto";
    const LoadedScene loaded = loadScene(scene);
    if (!std::filesystem::exists(resolvePath(loaded, loaded.scene.volume().path())))
        GTEST_SKIP() << "invesalius-examples is not installed";
    if (!std::filesystem::exists(resolvePath(loaded, loaded.scene.volume().label_path())))
        GTEST_SKIP() << "deploy/make-phantoms has not run";
    const SceneSetup simulation = setUpScene(loaded);
    const double share = shareOfChange(shadedVertices(loaded, simulation), 1e-3);
    RecordProperty("share_percent", std::to_string(100 * share));
    EXPECT_LE(share, 0.02);
}

}  // namespace
}  // namespace bonemill
