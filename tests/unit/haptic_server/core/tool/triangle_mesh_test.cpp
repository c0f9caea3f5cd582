#include <gtest/gtest.h>

#include <limits>

#include "common/base/user_error.h"
#include "haptic_server/scans/solid_mesh/mesh_file.h"
#include "tests/unit/haptic_server/core/tool/mesh_test_support.h"

namespace bonemill {
namespace {

using test::boxSoup;
using test::cornersOf;
using test::TriangleSoup;

const TriangleSoup kPlainBox = boxSoup({-1, -2, -3}, {1, 2, 3});

double volumeOf(const TriangleMesh& mesh) {
    double volume = 0;
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
        volume += mesh.vertex(t, 0).dot(mesh.areaNormal(t)) / 6;
    return volume;
}

void expectNeighboursShareTheEdge(const TriangleMesh& mesh) {
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (int e = 0; e < 3; ++e) {
            const auto& neighbour = mesh.triangles[mesh.neighbours[t][e]];
            int found = 0;
            for (int f = 0; f < 3; ++f)
                found += neighbour[f] == mesh.triangles[t][(e + 1) % 3] &&
                         neighbour[(f + 1) % 3] == mesh.triangles[t][e];
            EXPECT_EQ(found, 1) << "triangle " << t << " edge " << e;
        }
}

void expectRefused(const TriangleSoup& soup, const std::string& words) {
    try {
        closedMesh(cornersOf(soup), "burr.stl");
        ADD_FAILURE() << "accepted, expected: " << words;
    } catch (const UserError& e) {
        EXPECT_EQ(std::string(e.what()).find("burr.stl: "), 0u) << e.what();
        EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
    }
}

TEST(ClosedMesh, WeldsABox) {
    const TriangleMesh mesh = closedMesh(cornersOf(kPlainBox), "box.stl");
    EXPECT_EQ(mesh.vertices.size(), 8u);
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_NEAR(volumeOf(mesh), 48e-9, 1e-15);
    expectNeighboursShareTheEdge(mesh);
}

TEST(ClosedMesh, TurnsAnInsideOutBox) {
    const TriangleMesh mesh = closedMesh(cornersOf(test::insideOut(kPlainBox)), "box.stl");
    EXPECT_NEAR(volumeOf(mesh), 48e-9, 1e-15);
    expectNeighboursShareTheEdge(mesh);
}

TEST(ClosedMesh, WeldsBothZeros) {
    TriangleSoup soup = boxSoup({0, 0, 0}, {1, 1, 1});
    for (auto& p : soup[3])
        for (float& x : p)
            if (x == 0) x = -0.0f;
    EXPECT_EQ(closedMesh(cornersOf(soup), "box.stl").vertices.size(), 8u);
}

TEST(ClosedMesh, DropsTrianglesThatCollapse) {
    TriangleSoup soup = kPlainBox;
    soup.push_back({soup[0][0], soup[0][1], soup[0][1]});
    EXPECT_EQ(closedMesh(cornersOf(soup), "box.stl").triangles.size(), 12u);
    expectRefused({soup.back()}, "two equal corners");
}

TEST(ClosedMesh, RefusesAHole) {
    TriangleSoup soup = kPlainBox;
    soup.pop_back();
    expectRefused(soup, "not closed: 3 edges have one triangle only and 0 more than two");
}

TEST(ClosedMesh, RefusesAnInnerWall) {
    TriangleSoup soup = kPlainBox;
    const Eigen::Vector3f a = soup[0][0], b = soup[0][1];
    soup.push_back({a, b, Eigen::Vector3f(0, 0, 0)});
    expectRefused(soup, "2 edges have one triangle only and 1 more than two");
}

TEST(ClosedMesh, RefusesMixedOrientation) {
    TriangleSoup soup = kPlainBox;
    std::swap(soup[5][0], soup[5][1]);
    expectRefused(soup, "face different ways: 3 edges");
}

TEST(ClosedMesh, RefusesNumbersThatAreNone) {
    TriangleSoup soup = kPlainBox;
    soup[4][1].y() = std::numeric_limits<float>::quiet_NaN();
    soup[7][2].x() = std::numeric_limits<float>::infinity();
    expectRefused(soup, "2 of 36 triangle corners are not finite");
}

TEST(ClosedMesh, RefusesWhatIsNotInMillimetres) {
    expectRefused(boxSoup({0, 0, 0}, {0.002f, 0.016f, 0.002f}), "the tool is 0.016 mm large");
    expectRefused(boxSoup({0, 0, 0}, {2000, 16000, 2000}), "mm is accepted. Export it in millimetres");
}

TEST(ClosedMesh, RefusesNothing) {
    expectRefused({}, "holds no triangles");
    const TriangleSoup sheet{kPlainBox[0], {kPlainBox[0][1], kPlainBox[0][0], kPlainBox[0][2]}};
    expectRefused(sheet, "encloses no volume");
}

}  // namespace
}  // namespace bonemill
