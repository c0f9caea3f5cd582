#include <gtest/gtest.h>

#include <random>

#include "common/base/user_error.h"
#include "haptic_server/scans/densify/distance_transform.h"
#include "tests/support/test_bodies.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

MaterialTable tableOf(int protected_materials) {
    MaterialTable table(size_t(protected_materials) + 2);
    for (size_t id = 2; id < table.size(); ++id) table[id].is_protected = true;
    return table;
}

template <class MaterialOf>
BoneProperties propertiesOf(const Vector3i& dims, MaterialOf&& material) {
    VolumeGeometry geometry;
    geometry.dims = dims;
    return BoneProperties(VoxelVolume(geometry, test::kTestIso), material);
}

struct Scattered {
    std::vector<std::pair<Vector3i, MaterialId>> voxels;
    MaterialId at(const Vector3i& v) const {
        for (const auto& [place, id] : voxels)
            if (place == v) return id;
        return 1;  // not protected
    }
};
Scattered scattered(const Vector3i& dims, int count, std::mt19937& random) {
    Scattered all;
    for (int n = 0; n < count; ++n) {
        const Vector3i v(int(random() % unsigned(dims.x())), int(random() % unsigned(dims.y())),
                         int(random() % unsigned(dims.z())));
        if (all.at(v) == 1) all.voxels.push_back({v, MaterialId(2 + n % 3)});
    }
    return all;
}

// Every voxel, also outside of the volume, is compared with the search through all protected voxels.
TEST(ProtectedDistance, isThatOfTheNearestProtectedVoxel) {
    std::mt19937 random(3);
    for (const Vector3d& spacing : {Vector3d(1e-3, 1e-3, 1e-3), Vector3d(0.5e-3, 0.5e-3, 1.2e-3)}) {
        const Vector3i dims(23, 17, 19);
        const Scattered nerves = scattered(dims, 9, random);
        const auto properties = propertiesOf(dims, [&](const Vector3i& v) { return nerves.at(v); });
        constexpr double kReach = 6e-3;
        const auto field = protectedDistance(properties, tableOf(3), spacing, kReach);
        ASSERT_TRUE(field);
        forEachIndex({Vector3i::Constant(-4), dims.array() + 3}, [&](const Vector3i& v) {
            double nearest = 1e9, expected = 1e9;
            for (const auto& [place, id] : nerves.voxels) {
                const Vector3d way = spacing.cwiseProduct((v - place).cast<double>());
                nearest = std::min(nearest, way.norm());
                // The face is half a voxel nearer in this direction; isolated voxels are inside by half of
                // their thinnest edge.
                const double half =
                    way.isZero() ? spacing.x() : way.normalized().cwiseProduct(spacing).norm();
                expected = std::min(expected, way.norm() - half / 2);
            }
            const DistanceSample sample = field->at(spacing.cwiseProduct(v.cast<double>()));
            if (std::abs(expected - kReach) < 0.4e-3) return;  // known on one side only
            if (expected > kReach) {
                EXPECT_EQ(sample.nearest, kNoMaterial);
                EXPECT_NEAR(sample.distance, kReach, 1e-9);
                return;
            }
            // Nearest by its centre need not be nearest by its face when voxels are no cubes.
            const double slack = nearest > 0 && spacing.x() != spacing.z() ? 0.36e-3 : 1e-6;
            EXPECT_NEAR(sample.distance, expected, slack) << v.transpose();
            if (nearest > 0) {
                EXPECT_GE(sample.distance, nearest - 0.5 * spacing.maxCoeff() - 1e-6);
            }
            EXPECT_GE(sample.nearest, 2);
        });
    }
}

TEST(ProtectedDistance, namesTheNearestStructure) {
    const Vector3i dims(40, 10, 10);
    const auto properties = propertiesOf(dims, [](const Vector3i& v) {
        return MaterialId(v.x() < 3 ? 2 : v.x() >= 37 ? 3 : 0);
    });
    const auto field = protectedDistance(properties, tableOf(2), Vector3d::Constant(1e-3), 30e-3);
    EXPECT_EQ(field->at({10e-3, 5e-3, 5e-3}).nearest, 2);
    EXPECT_EQ(field->at({30e-3, 5e-3, 5e-3}).nearest, 3);
    EXPECT_NEAR(field->at({10e-3, 5e-3, 5e-3}).distance, 7.5e-3, 1e-6);
    EXPECT_NEAR(field->at({1e-3, 5e-3, 5e-3}).distance, -1.5e-3, 1e-6);
}

TEST(ProtectedDistance, ofABallIsTheDistanceOfItsSurface) {
    constexpr double kSpacing = 0.25e-3, kRadius = 2e-3;
    const Vector3d center = kSpacing * Vector3d(24, 24, 24);
    const auto properties = propertiesOf({49, 49, 49}, [&](const Vector3i& v) {
        return MaterialId((kSpacing * v.cast<double>() - center).norm() < kRadius ? 2 : 0);
    });
    const auto field = protectedDistance(properties, tableOf(1), Vector3d::Constant(kSpacing), 4e-3);
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    for (int n = 0; n < 500; ++n) {
        const Vector3d out = Vector3d(normal(random), normal(random), normal(random)).normalized();
        const double from_surface = std::uniform_real_distribution<double>(-1.5e-3, 3.5e-3)(random);
        const DistanceSample sample = field->at(center + (kRadius + from_surface) * out);
        EXPECT_NEAR(sample.distance, from_surface, 0.6 * kSpacing);
        if (std::abs(from_surface) > 2 * kSpacing) {
            EXPECT_GT(sample.gradient_V.dot(out), 0.7);
        }
    }
}

TEST(ProtectedDistance, gradientIsThatOfTheTrilinearField) {
    std::mt19937 random(5);
    const Vector3i dims(20, 20, 20);
    const Scattered nerves = scattered(dims, 12, random);
    const Vector3d spacing(0.5e-3, 0.4e-3, 0.8e-3);
    const auto field = protectedDistance(propertiesOf(dims, [&](const Vector3i& v) { return nerves.at(v); }),
                                         tableOf(3), spacing, 3e-3);
    std::uniform_real_distribution<double> place(0.1, 0.9);
    for (int n = 0; n < 500; ++n) {
        const Vector3d in_cell(place(random), place(random), place(random));
        const Vector3i cell(int(random() % 19), int(random() % 19), int(random() % 19));
        const Vector3d p = spacing.cwiseProduct(cell.cast<double>() + in_cell);
        const DistanceSample sample = field->at(p);
        for (int axis = 0; axis < 3; ++axis) {
            const Vector3d step = 1e-6 * Vector3d::Unit(axis);
            const double slope = (field->at(p + step).distance - field->at(p - step).distance) / 2e-6;
            EXPECT_NEAR(slope, sample.gradient_V[axis], 1e-9);
        }
    }
}

// Large volumes are done slab by slab.
TEST(ProtectedDistance, slabsGiveTheSame) {
    std::mt19937 random(6);
    const Vector3i dims(30, 30, 90);
    const Scattered nerves = scattered(dims, 10, random);
    const auto properties = propertiesOf(dims, [&](const Vector3i& v) { return nerves.at(v); });
    const Vector3d spacing = Vector3d::Constant(1e-3);
    const auto whole = protectedDistance(properties, tableOf(3), spacing, 9e-3);
    const auto slabs = protectedDistance(properties, tableOf(3), spacing, 9e-3, 1);
    forEachIndex({Vector3i::Constant(-12), dims.array() + 12}, [&](const Vector3i& v) {
        const Vector3d p = spacing.cwiseProduct(v.cast<double>());
        ASSERT_EQ(whole->at(p).distance, slabs->at(p).distance);
        ASSERT_EQ(whole->at(p).nearest, slabs->at(p).nearest);
    });
}

TEST(ProtectedDistance, refusesAReachOfFarTooManyVoxels) {
    const auto properties =
        propertiesOf({16, 16, 16}, [](const Vector3i& v) { return MaterialId(v.x() == 8 ? 2 : 1); });
    EXPECT_THROW(protectedDistance(properties, tableOf(1), Vector3d::Constant(0.125e-3), 52e-3), UserError);
    EXPECT_THROW(protectedDistance(properties, tableOf(1), Vector3d::Constant(1e-6), 52e-3), UserError);
    EXPECT_TRUE(protectedDistance(properties, tableOf(1), Vector3d::Constant(1e-3), 52e-3));
}

TEST(ProtectedDistance, isNullWithoutProtectedVoxels) {
    const auto properties = propertiesOf({9, 9, 9}, [](const Vector3i&) { return MaterialId(1); });
    EXPECT_FALSE(protectedDistance(properties, tableOf(1), Vector3d::Ones(), 5));
}

}  // namespace
}  // namespace bonemill
