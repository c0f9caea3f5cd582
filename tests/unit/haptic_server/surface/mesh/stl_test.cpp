#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include "common/base/user_error.h"
#include "haptic_server/surface/mesh/mesh_check.h"
#include "haptic_server/surface/mesh/mesh_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

struct StlTriangle {
    Eigen::Vector3f normal;
    std::array<Eigen::Vector3f, 3> points;
};

std::vector<StlTriangle> readStl(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream content;
    content << file.rdbuf();
    const std::string bytes = content.str();
    uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, 4);
    EXPECT_EQ(bytes.size(), 84 + 50 * size_t(count));
    EXPECT_NE(bytes.substr(0, 5), "solid");
    std::vector<StlTriangle> triangles;
    for (size_t at = 84; at + 50 <= bytes.size(); at += 50) {
        std::array<float, 12> v;
        std::memcpy(v.data(), bytes.data() + at, sizeof v);
        triangles.push_back({Eigen::Vector3f(v[0], v[1], v[2]),
                             {Eigen::Vector3f(v[3], v[4], v[5]), Eigen::Vector3f(v[6], v[7], v[8]),
                              Eigen::Vector3f(v[9], v[10], v[11])}});
    }
    return triangles;
}

class StlTest : public testing::Test {
  protected:
    StlTest() : volume_(test::boxGeometry({25, 22, 28}), 32768) {
        std::mt19937 random(9);
        test::fillWaves(volume_, random);
        lattice_.emplace(volume_, Eigen::Vector3i(7, 7, 7));
        grid_.emplace(volume_, *lattice_);
        meshes_ = test::meshAll(volume_, *lattice_);
        X_WV_.position = {0.123, -0.045, 0.2};
        X_WV_.rotation = expRotation({0.3, -0.7, 1.1});
    }

    test::TemporaryFolder folder_;
    const std::string path_ = folder_ / "mesh.stl";
    VoxelVolume volume_;
    std::optional<LeafLattice> lattice_;
    std::optional<MeshGrid> grid_;
    std::vector<NodeMesh> meshes_;
    Pose X_WV_;
};

TEST_F(StlTest, HasTheTrianglesInMillimetresInWorld) {
    saveStl(path_, meshes_, *grid_, X_WV_);
    const auto triangles = readStl(path_);
    ASSERT_EQ(triangles.size(), checkMesh(meshes_, *grid_).triangles);
    size_t n = 0;
    for (const NodeMesh& mesh : meshes_)
        for (const uint32_t index : mesh.indices) {
            const PackedVertex& v = mesh.vertices[index];
            const Eigen::Vector3d p_V =
                (mesh.origin + mesh.step.cwiseProduct(Eigen::Vector3f(v.x, v.y, v.z))).cast<double>();
            const Eigen::Vector3d p_W_mm = (X_WV_ * p_V) * 1000;
            EXPECT_LT((triangles[n / 3].points[n % 3].cast<double>() - p_W_mm).norm(), 1e-4);
            ++n;
        }
}

TEST_F(StlTest, IsClosedForAReaderThatMergesEqualPoints) {
    saveStl(path_, meshes_, *grid_, X_WV_);
    using Point = std::array<float, 3>;
    std::map<std::pair<Point, Point>, int> balance;
    double six_volumes = 0;
    for (const StlTriangle& t : readStl(path_)) {
        six_volumes +=
            t.points[0].cast<double>().dot(t.points[1].cast<double>().cross(t.points[2].cast<double>()));
        const Eigen::Vector3f normal = (t.points[1] - t.points[0]).cross(t.points[2] - t.points[0]);
        EXPECT_GE(normal.dot(t.normal), 0);
        for (int corner = 0; corner < 3; ++corner) {
            const Eigen::Vector3f& a = t.points[corner];
            const Eigen::Vector3f& b = t.points[(corner + 1) % 3];
            const Point from{a.x(), a.y(), a.z()};
            const Point to{b.x(), b.y(), b.z()};
            ++balance[{from, to}];
            --balance[{to, from}];
        }
    }
    for (const auto& [edge, count] : balance) EXPECT_EQ(count, 0);
    const double volume_mm3 = meshVolume(meshes_, *grid_) * 1e9;
    EXPECT_NEAR(six_volumes / 6, volume_mm3, 1e-4 * volume_mm3);
}

TEST_F(StlTest, NoSurfaceGivesAnEmptyFile) {
    saveStl(path_, {}, *grid_, X_WV_);
    EXPECT_TRUE(readStl(path_).empty());
}

TEST_F(StlTest, UnwritablePathIsAUserError) {
    const std::string path = folder_ / "no_such_folder/mesh.stl";
    try {
        saveStl(path, meshes_, *grid_, X_WV_);
        FAIL() << "no error";
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find(path), std::string::npos);
    }
}

}  // namespace
}  // namespace bonemill
