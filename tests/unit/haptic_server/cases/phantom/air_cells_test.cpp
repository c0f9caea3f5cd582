#include "haptic_server/cases/phantom/air_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace bonemill {
namespace {

using Eigen::Vector3d;

AirCells cellsInABall(uint64_t seed) {
    AirCells::Region region;
    region.box = Eigen::AlignedBox3d(Vector3d::Constant(-8), Vector3d::Constant(8));
    region.depth = [](const Vector3d& p) { return 8 - p.norm(); };
    region.radius = [](const Vector3d&) { return 1.5; };
    return {region, seed};
}

std::vector<Vector3d> placesInTheBall(int count) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> at(-7, 7);
    std::vector<Vector3d> places;
    while (int(places.size()) < count) {
        const Vector3d p(at(random), at(random), at(random));
        if (p.norm() < 7) places.push_back(p);
    }
    return places;
}

TEST(AirCells, AreThoseOfTheirSeed) {
    const AirCells a = cellsInABall(1), again = cellsInABall(1), b = cellsInABall(2);
    EXPECT_EQ(a.count(), again.count());
    int differing = 0;
    for (const Vector3d& p : placesInTheBall(200)) {
        const double depth = a.depth(p, a.seedsNear(p, 0));
        EXPECT_EQ(depth, again.depth(p, again.seedsNear(p, 0)));
        differing += std::abs(depth - b.depth(p, b.seedsNear(p, 0))) > 0.05;
    }
    EXPECT_GT(differing, 150);
}

// A cube's cells must not end at the next cube.
TEST(AirCells, DoNotDependOnTheNeighbourhoodThatIsAskedFor) {
    const AirCells cells = cellsInABall(1);
    for (const Vector3d& p : placesInTheBall(300)) {
        const auto small = cells.seedsNear(p, 0), large = cells.seedsNear(p + Vector3d(0.5, -0.4, 0.3), 1.5);
        EXPECT_LT(small.size(), large.size());
        EXPECT_EQ(cells.depth(p, small), cells.depth(p, large)) << p.transpose();
    }
}

TEST(AirCells, HaveWallsWithHolesAndMostOfTheRoom) {
    const AirCells cells = cellsInABall(1);
    int air = 0, walls = 0, through = 0;
    for (const Vector3d& p : placesInTheBall(3000)) {
        (cells.depth(p, cells.seedsNear(p, 0)) > 0 ? air : walls)++;
        // Another cell within half a millimetre, and no wall on the way.
        const Vector3d q = p + Vector3d(0.5, 0, 0);
        if (cells.cellAt(p) == cells.cellAt(q)) continue;
        bool is_open = true;
        for (double s = 0; s <= 1; s += 0.1) {
            const Vector3d between = p + s * (q - p);
            is_open = is_open && cells.depth(between, cells.seedsNear(between, 0)) > 0;
        }
        through += is_open;
    }
    EXPECT_GT(air, 1500);
    EXPECT_GT(walls, 500);
    EXPECT_GT(through, 20);
    EXPECT_LT(through, 300);
}

// Holes end inside their wall, and leave no leaf of bone that is thinner than a wall.
TEST(AirCells, HaveNoLeaves) {
    const AirCells cells = cellsInABall(1);
    constexpr double kStep = 0.01, kMost = 0.15;
    for (const Vector3d& p : placesInTheBall(3000)) {
        const Vector3d q = p + Vector3d(0, kStep, 0);
        const double change = cells.depth(p, cells.seedsNear(p, 0)) - cells.depth(q, cells.seedsNear(q, 0));
        EXPECT_LE(std::abs(change), kMost) << p.transpose();
    }
}

}  // namespace
}  // namespace bonemill
