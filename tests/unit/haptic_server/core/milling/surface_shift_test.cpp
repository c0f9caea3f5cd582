// The surface goes where it is sent, and stays where it is not.
#include "haptic_server/core/milling/surface_shift.h"

#include <gtest/gtest.h>

#include "haptic_server/surface/mesh/mesh_check.h"
#include "tests/support/bone_volume.h"
#include "tests/support/test_bodies.h"
#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr double kEnergy = 0.4e9;  // J/m³
constexpr double kReach = 1.2e-3;  // m
constexpr size_t kMaxCells = 1'000'000;
const Burr kNoBurr{.radius = 0};

struct Plane {
    Vector3d point{2.51e-3, 2.48e-3, 2.53e-3}, normal;
    double heightOf(const Vector3d& p) const { return normal.dot(p - point); }
    double sideways(const Vector3d& p) const { return (p - point - heightOf(p) * normal).norm(); }
};

BoneModel halfSpace(const Plane& plane, const Vector3d& spacing, int factor) {
    VolumeGeometry geometry;
    geometry.spacing = spacing;
    geometry.dims = (5e-3 / spacing.array()).ceil().cast<int>() + 1;
    return BoneModel(test::bodyVolume(geometry, test::halfSpace(plane.point, plane.normal)),
                     Eigen::Vector3i::Constant(16), {.levels = {{factor}}});
}

template <class Visit>
void forEachPoint(const BoneModel& bone, Visit&& visit) {
    for (LeafId leaf = 0; leaf < bone.lattice.leafCount(); ++leaf)
        bone.shell.forEachBlock(0, leaf, [&](const ShellBlock& b, uint32_t count) {
            for (uint32_t n = 0; n < count; ++n)
                visit(Vector3d(b.x[n], b.y[n], b.z[n]), double(b.area[n]), PatchId{leaf, b.key[n]});
        });
}

SpecificEnergyConfig uniform() {
    return {.reference = kEnergy, .reference_density = kMaxDensity, .exponent = 0, .materials = {}};
}

// It is not on the faces of the volume.
bool isOfPlane(const BoneModel& bone, const Vector3d& p) {
    const double border = 3 * bone.volume.spacing().maxCoeff();
    return p.minCoeff() > border && p.maxCoeff() < 5e-3 - border;
}

// The surface is lowered everywhere within kReach of the plane's point by this much, in so many ticks.
double lower(BoneModel& bone, const Plane& plane, double recession, int ticks) {
    SurfaceShift shift(bone, 1.5 * kReach, 65536, kMaxCells);
    SpecificEnergy u(uniform(), nullptr, bone.volume.iso());
    double spent = 0;
    for (int n = 0; n < ticks; ++n) {
        shift.begin(bone, kNoBurr, {plane.point, Eigen::Quaterniond::Identity()});
        forEachPoint(bone, [&](const Vector3d& p, double area, PatchId patch) {
            if (plane.sideways(p) < kReach && isOfPlane(bone, p))
                shift.add(bone, patch, kEnergy * area * recession / ticks, 1e-3);
        });
        MillingResult result;
        spent += shift.apply(bone, u, 1, 1, result);
        EXPECT_TRUE(result.has_room && result.shell_is_complete && !result.is_cut_short);
    }
    return spent;
}

class SurfaceShiftOf : public testing::TestWithParam<int> {};  // shell factor

TEST_P(SurfaceShiftOf, APlaneKeepsItFlatAndLeavesTheRest) {
    for (const Vector3d& normal : {Vector3d(0, 0, 1), Vector3d(1, 2, 3), Vector3d(1, 1, 0)})
        for (const Vector3d& spacing_mm : {Vector3d(0.125, 0.125, 0.125), Vector3d(0.1, 0.15, 0.2)}) {
            const Plane plane{.normal = normal.normalized()};
            BoneModel bone = halfSpace(plane, 1e-3 * spacing_mm, GetParam());
            const double before = test::boneVolume(bone), voxel = 1e-3 * spacing_mm.maxCoeff();
            constexpr double kDepth = 0.2e-3;
            const double spent = lower(bone, plane, kDepth, 40);
            EXPECT_NEAR(kEnergy * (before - test::boneVolume(bone)) / spent, 1, 2e-3);
            const double rim = (1 + GetParam()) * voxel;
            size_t inside = 0;
            forEachPoint(bone, [&](const Vector3d& p, double, PatchId) {
                if (!isOfPlane(bone, p)) return;
                if (plane.sideways(p) < kReach - rim) {
                    EXPECT_NEAR(plane.heightOf(p), -kDepth, 0.06 * kDepth);
                    ++inside;
                } else if (plane.sideways(p) > kReach + rim) {
                    EXPECT_NEAR(plane.heightOf(p), 0, 0.02 * kDepth);
                }
            });
            EXPECT_GT(inside, 10u);
        }
}

INSTANTIATE_TEST_SUITE_P(ShellFactors, SurfaceShiftOf, testing::Values(1, 2));

// What is less than a count of density per tick adds up.
TEST(SurfaceShift, TakesSmallStepsAsWellAsLargeOnes) {
    const Plane plane{.normal = Vector3d(1, 2, 3).normalized()};
    BoneModel bone = halfSpace(plane, Vector3d::Constant(0.125e-3), 1);
    constexpr double kStep = 2e-9;  // m: a quarter of a count
    constexpr int kTicks = 500;
    double area = 0;
    forEachPoint(bone, [&](const Vector3d& p, double a, PatchId) {
        if (plane.sideways(p) < kReach && isOfPlane(bone, p)) area += a;
    });
    EXPECT_NEAR(lower(bone, plane, kTicks * kStep, kTicks) / (kEnergy * area * kTicks * kStep), 1, 0.05);
}

TEST(SurfaceShift, MovesNoFartherThanAQuarterOfAVoxelOrTheDepth) {
    const Plane plane{.normal = Vector3d::UnitZ()};
    for (const double depth : {1e-3, 5e-6}) {
        BoneModel bone = halfSpace(plane, Vector3d::Constant(0.125e-3), 1);
        SurfaceShift shift(bone, 1.5 * kReach, 65536, kMaxCells);
        shift.begin(bone, kNoBurr, {plane.point, Eigen::Quaterniond::Identity()});
        forEachPoint(bone, [&](const Vector3d& p, double, PatchId patch) {
            if (plane.sideways(p) < kReach && isOfPlane(bone, p)) shift.add(bone, patch, 1, depth);
        });
        SpecificEnergy u(uniform(), nullptr, bone.volume.iso());
        MillingResult result;
        shift.apply(bone, u, 1, 1, result);
        double lowest = 0;
        forEachPoint(bone, [&](const Vector3d& p, double, PatchId) {
            if (plane.sideways(p) < kReach / 2 && isOfPlane(bone, p))
                lowest = std::min(lowest, plane.heightOf(p));
        });
        EXPECT_NEAR(lowest, -std::min(depth, SurfaceShift::kMaxShift * 0.125e-3), 0.3e-6);
    }
}

// One keeps what it knows of cells from tick to tick, the other begins anew in each; in between somebody else
// puts bone back.
TEST(SurfaceShift, WhatItRemembersOfCellsChangesNothing) {
    const Plane plane{.normal = Vector3d(1, 2, 3).normalized()};
    BoneModel bones[2] = {halfSpace(plane, Vector3d::Constant(0.125e-3), 1),
                          halfSpace(plane, Vector3d::Constant(0.125e-3), 1)};
    const BoneModel whole = halfSpace(plane, Vector3d::Constant(0.125e-3), 1);
    const auto shiftOf = [](const BoneModel& bone) {
        return SurfaceShift(bone, 1.5 * kReach, 65536, kMaxCells);
    };
    SpecificEnergy u(uniform(), nullptr, whole.volume.iso());
    const auto tick = [&](SurfaceShift& shift, BoneModel& bone) {
        shift.begin(bone, kNoBurr, {plane.point, Eigen::Quaterniond::Identity()});
        forEachPoint(bone, [&](const Vector3d& p, double area, PatchId patch) {
            if (plane.sideways(p) < kReach) shift.add(bone, patch, kEnergy * area * 10e-6, 1e-3);
        });
        MillingResult result;
        return shift.apply(bone, u, 1, 1, result);
    };
    SurfaceShift kept = shiftOf(bones[0]);
    for (int n = 0; n < 12; ++n) {
        SurfaceShift anew = shiftOf(bones[1]);
        for (int before = 0; before < n; ++before) anew.begin(bones[1], kNoBurr, {});  // what it rounds by
        const double spent = tick(kept, bones[0]);
        EXPECT_GT(spent, 0);
        EXPECT_EQ(tick(anew, bones[1]), spent) << n;
        if (n % 4 != 3) continue;
        const IndexBox part{{18, 18, 0}, {22, 22, 40}};
        for (BoneModel& bone : bones) {
            test::writeLikeTick(bone.volume, bone.lattice, part,
                                [&](int i, int j, int k) { return whole.volume.at(i, j, k); });
            ASSERT_TRUE(bone.shell.refresh(bone.volume, bone.lattice, {&part, 1}));
        }
    }
    test::forEachVoxel(test::wholeBox(whole.volume), [&](int i, int j, int k) {
        ASSERT_EQ(bones[0].volume.at(i, j, k), bones[1].volume.at(i, j, k)) << i << ' ' << j << ' ' << k;
    });
}

// The face beside it, which nothing touches, has no say in the burr.
TEST(SurfaceShift, ACrumbInsideTheBurrGoes) {
    const Vector3d spacing = Vector3d::Constant(0.125e-3);
    const Plane plane{.normal = Vector3d::UnitZ()};
    VolumeGeometry geometry = test::cubeGeometry(41, spacing.x());
    VoxelVolume volume = test::bodyVolume(geometry, test::halfSpace(plane.point, plane.normal));
    const Eigen::Vector3i crumb(20, 20, 21);
    volume.set(crumb.x(), crumb.y(), crumb.z(), Density(volume.iso() + 6));
    BoneModel bone(std::move(volume), Eigen::Vector3i::Constant(16), {.levels = {{1}}});
    const Pose X_VT{spacing.cwiseProduct(crumb.cast<double>()), Eigen::Quaterniond::Identity()};
    const Burr burr{.radius = 0.05e-3};
    SurfaceShift shift(bone, 1.5 * kReach, 65536, kMaxCells);
    SpecificEnergy u(uniform(), nullptr, bone.volume.iso());
    for (int n = 0; n < 3; ++n) {
        shift.begin(bone, burr, X_VT);
        forEachPoint(bone, [&](const Vector3d& p, double, PatchId patch) {
            if ((p - X_VT.position).norm() < burr.radius) shift.add(bone, patch, 1e-6, 50e-6);
        });
        MillingResult result;
        shift.apply(bone, u, 1, 1, result);
    }
    EXPECT_LT(bone.volume.at(crumb.x(), crumb.y(), crumb.z()), bone.volume.iso());
}

TEST(SurfaceShift, LeavesTheRestForTheNextTickWhereTimeIsShort) {
    const Plane plane{.normal = Vector3d::UnitZ()};
    BoneModel bone = halfSpace(plane, Vector3d::Constant(0.125e-3), 1);
    SurfaceShift shift(bone, 1.5 * kReach, 65536, 1);
    SpecificEnergy u(uniform(), nullptr, bone.volume.iso());
    IndexBox changed;
    int short_ticks = 0;
    for (int n = 0; n < 20; ++n) {
        shift.begin(bone, kNoBurr, {plane.point, Eigen::Quaterniond::Identity()});
        forEachPoint(bone, [&](const Vector3d& p, double area, PatchId patch) {
            if (plane.sideways(p) < kReach && isOfPlane(bone, p))
                shift.add(bone, patch, kEnergy * area * 1e-6, 1e-3);
        });
        MillingResult result;
        EXPECT_GT(shift.apply(bone, u, 1, 1, result), 0);
        short_ticks += result.is_cut_short;
        changed.include(result.changed);
    }
    EXPECT_EQ(short_ticks, 20);  // one leaf each
    EXPECT_GE((changed.max - changed.min).head<2>().minCoeff(), int(2 * kReach / 0.125e-3) - 2);
}

}  // namespace
}  // namespace bonemill
