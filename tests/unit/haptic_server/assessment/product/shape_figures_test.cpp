#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "haptic_server/assessment/product/breach.h"
#include "haptic_server/assessment/product/judge.h"
#include "tests/unit/haptic_server/assessment/product/block_task.h"

namespace bonemill {
namespace {

using test::valueOf;

constexpr double kHalfVoxel = 0.13;  // mm, of voxels of 0.25 mm

// A task to take away everything above 4 mm.
test::BlockTask topTask(const Eigen::Vector3i& size = {40, 40, 24}) {
    test::BlockTask block(size);
    block.addZone("top", ZoneRole::kTarget, [](const auto& p) { return p.z() > 4e-3; });
    block.finishZones();
    return block;
}

TEST(Deviation, aPlaneTooDeepIsOverCutByItsOffset) {
    test::BlockTask block = topTask();
    block.mill([](const auto& p) { return p.z() > 3e-3; });
    const Figures figures = block.figures();
    EXPECT_NEAR(valueOf(figures, "overcut.max"), 1, kHalfVoxel);
    EXPECT_NEAR(valueOf(figures, "overcut.p95"), 1, kHalfVoxel);
    // Near the rim the block's side is nearer than the plane: a frame of a millimetre tapers off.
    EXPECT_NEAR(valueOf(figures, "overcut.mean"), 0.83, 0.15);
    EXPECT_EQ(valueOf(figures, "undercut.max"), 0);
}

TEST(Deviation, aPlaneNotDeepEnoughIsUnderCut) {
    test::BlockTask block = topTask();
    block.mill([](const auto& p) { return p.z() > 5e-3; });
    const Figures figures = block.figures();
    EXPECT_NEAR(valueOf(figures, "undercut.max"), 1, kHalfVoxel);
    EXPECT_LT(valueOf(figures, "overcut.max"), kHalfVoxel);
}

TEST(Deviation, aLargerBallIsOverCutAllAround) {
    test::BlockTask block({56, 56, 56});
    const auto radius = [](const auto& p) { return (p - Eigen::Vector3d::Constant(7e-3)).norm(); };
    block.addZone("ball", ZoneRole::kTarget, [&](const auto& p) { return radius(p) < 3e-3; });
    block.finishZones();
    block.mill([&](const auto& p) { return radius(p) < 4e-3; });
    const Figures figures = block.figures();
    EXPECT_NEAR(valueOf(figures, "overcut.mean"), 1, kHalfVoxel);
    EXPECT_LT(valueOf(figures, "overcut.sd"), kHalfVoxel);
    EXPECT_EQ(valueOf(figures, "undercut.max"), 0);
}

TEST(Deviation, thePictureIsDrawnAndTheSameEachTime) {
    test::BlockTask block = topTask();
    block.mill([](const auto& p) { return p.z() > (p.x() > 5e-3 ? 3e-3 : 5e-3); });
    const Product one = measureProduct({block.scanned(), block.now(), block.task}),
                  two = measureProduct({block.scanned(), block.now(), block.task});
    EXPECT_EQ(one.picture.png.substr(1, 3), "PNG");
    EXPECT_EQ(one.picture.png, two.picture.png);
    EXPECT_EQ(one.picture.scale, 1e-3);
    ASSERT_EQ(one.figures.size(), two.figures.size());
    for (size_t n = 0; n < one.figures.size(); ++n) EXPECT_EQ(one.figures[n].value, two.figures[n].value);
}

TEST(CavityForm, aBoxHasItsDepthWidthAndUprightWalls) {
    test::BlockTask block = topTask();
    block.task.approach_V = -Eigen::Vector3d::UnitZ();
    block.carve([](const auto& p) {
        return std::max({std::abs(p.x() - 5e-3) - 2e-3, std::abs(p.y() - 5e-3) - 1e-3, 3e-3 - p.z()});
    });
    const Figures figures = block.figures();
    EXPECT_NEAR(valueOf(figures, "cavity.depth_mean"), 3, kHalfVoxel);
    EXPECT_LT(valueOf(figures, "cavity.depth_sd"), kHalfVoxel);
    EXPECT_NEAR(valueOf(figures, "cavity.isthmus"), 2, 2 * kHalfVoxel);
    EXPECT_NEAR(valueOf(figures, "cavity.wall_taper"), 0, 3);
    EXPECT_LT(valueOf(figures, "cavity.undercut_area"), 1);
}

TEST(CavityForm, wallsThatOpenAndWallsThatCloseAreToldApart) {
    const auto taperOf = [](double slope) {
        test::BlockTask block = topTask();
        block.task.approach_V = -Eigen::Vector3d::UnitZ();
        block.carve([slope](const auto& p) {
            const double up = p.z() - 3e-3, out = (p.head(2).array() - 5e-3).abs().maxCoeff();
            return std::max(-up, (out - 2e-3 - slope * (up - 1.5e-3)) / std::hypot(1, slope));
        });
        return block.figures();
    };
    const double angle = 20, slope = std::tan(angle * std::numbers::pi / 180);
    const Figures opens = taperOf(slope), closes = taperOf(-slope);
    EXPECT_NEAR(valueOf(opens, "cavity.wall_taper"), angle, 4);
    EXPECT_NEAR(valueOf(closes, "cavity.wall_taper"), -angle, 4);
    EXPECT_LT(valueOf(opens, "cavity.undercut_area"), 3);
    // Four walls, 3 mm high and 4 mm wide on the mean.
    EXPECT_NEAR(valueOf(closes, "cavity.undercut_area"), 4 * 4 * 3 / std::cos(angle * std::numbers::pi / 180),
                6);
}

TEST(Structures, aCylinderUnderBoneIsExposedSkeletonisedAndCovered) {
    // A nerve of 2 mm along y, 3 mm below the top.
    test::BlockTask block({48, 64, 40});
    const auto from_axis = [](const auto& p) { return std::hypot(p.x() - 6e-3, p.z() - 6e-3); };
    block.addZone("nerve", ZoneRole::kProtected, [&](const auto& p) { return from_axis(p) < 1e-3; });
    block.finishZones();
    block.task.structures = {{.name = "nerve", .zone = 1}};
    block.task.skeletonised = 1e-3;
    // Over a quarter of its length it is laid bare all around; over another, half a millimetre is left.
    block.mill([&](const auto& p) {
        return (p.y() < 4e-3 && from_axis(p) < 2e-3 && from_axis(p) >= 1e-3) ||
               (p.y() >= 4e-3 && p.y() < 8e-3 && from_axis(p) >= 1.5e-3 && from_axis(p) < 3e-3);
    });
    const Figures figures = block.figures();
    const double quarter = std::numbers::pi * 2 * 4;
    EXPECT_NEAR(valueOf(figures, "structure.exposed_area:nerve") / quarter, 1, 0.08);
    EXPECT_NEAR(valueOf(figures, "structure.skeletonised_area:nerve") / quarter, 1, 0.12);
    EXPECT_NEAR(valueOf(figures, "structure.covered_area:nerve") / (2 * quarter), 1, 0.08);
    EXPECT_EQ(valueOf(figures, "structure.lost_voxels:nerve"), 0);
    EXPECT_EQ(valueOf(figures, "zone.removed:nerve"), 0);
}

TEST(Structures, whatIsGoneOfThemIsLost) {
    test::BlockTask block({40, 40, 24});
    block.addZone("sinus", ZoneRole::kProtected, [](const auto& p) { return p.z() < 2e-3; });
    block.finishZones();
    block.task.structures = {{.name = "sinus", .zone = 1}};
    block.mill([](const auto& p) { return p.x() < 1e-3 && p.y() < 2e-3 && p.z() > 1.5e-3; });
    EXPECT_NEAR(valueOf(block.figures(), "structure.lost_volume:sinus"), 1 * 2 * 0.5, 1e-9);
    EXPECT_EQ(valueOf(block.figures(), "structure.lost_voxels:sinus"), 64);
}

// The plan goes down through the middle of a column of 10 x 10 mm and 16 mm height.
struct BreachedColumn {
    BreachedColumn() : block({40, 40, 64}) {
        block.addZone("hole", ZoneRole::kTarget, [](const auto& p) {
            return std::hypot(p.x() - 5e-3, p.y() - 5e-3) < 2e-3 && p.z() > 4e-3;
        });
        block.finishZones();
        block.task.plan = PlannedLine{block.inV({5e-3, 5e-3, 16e-3}), block.inV({5e-3, 5e-3, 4e-3}), 4e-3};
        bone = std::make_shared<const SolidBone>(block.scanned(), *block.task.plan);
        burr.kind = BurrKind::kBall;
        burr.radius = 1e-3;
    }
    // The tool goes along a line from a to b (B), its shaft upright towards the hand or leaning as the line.
    double depthAlong(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
        BreachMeter meter(bone, *block.task.plan);
        Pose X_VT;
        X_VT.rotation = rotationBetween(Eigen::Vector3d::UnitY(), a - b);
        for (int n = 0; n <= 200; ++n) {
            X_VT.position = block.inV(a + n / 200.0 * (b - a));
            meter.add(X_VT, BurrProbes(burr));
        }
        return meter.depth();
    }

    test::BlockTask block;
    std::shared_ptr<const SolidBone> bone;
    Burr burr;
};

TEST(Breach, aToolThatLeansThroughTheWallIsOutByItsDepth) {
    const BreachedColumn column;
    // In the end the burr's centre is 2 mm out of the face x = 10 mm; its surface 3 mm.
    const double depth = column.depthAlong({5e-3, 5e-3, 17e-3}, {12e-3, 5e-3, 6e-3});
    EXPECT_NEAR(depth, 3e-3, 0.15e-3);
    EXPECT_EQ(breachGrade(depth), 2);
    Figures figures;
    addBreachFigures(depth, figures);
    EXPECT_NEAR(valueOf(figures, "breach.depth"), 3, 0.15);
    EXPECT_EQ(valueOf(figures, "breach.grade"), 2);
}

TEST(Breach, aCentredToolAndOneBesideTheBoneBreachNothing) {
    const BreachedColumn column;
    EXPECT_EQ(column.depthAlong({5e-3, 5e-3, 17e-3}, {5e-3, 5e-3, 4e-3}), 0);
    // Through the air beside the column it has come through no wall.
    EXPECT_EQ(column.depthAlong({13e-3, 5e-3, 17e-3}, {13e-3, 5e-3, 4e-3}), 0);
    // It comes from outside: what stands out near the entry does not count.
    EXPECT_EQ(column.depthAlong({9.5e-3, 5e-3, 17e-3}, {9.5e-3, 5e-3, 13e-3}), 0);
}

TEST(Breach, gradesAreThoseOfGertzbeinAndRobbins) {
    EXPECT_EQ(breachGrade(0), 0);
    EXPECT_EQ(breachGrade(0.1e-3), 1);
    EXPECT_EQ(breachGrade(1.9e-3), 1);
    EXPECT_EQ(breachGrade(2e-3), 2);
    EXPECT_EQ(breachGrade(3.9e-3), 2);
    EXPECT_EQ(breachGrade(5.9e-3), 3);
    EXPECT_EQ(breachGrade(6e-3), 4);
    EXPECT_EQ(breachGrade(50e-3), 4);
}

TEST(Plan, aLeaningHoleIsOffByItsAngleAndPlaces) {
    BreachedColumn column;
    // From 1 mm beside the entry, leaning 8 degrees, 10 mm deep.
    const double angle = 8 * std::numbers::pi / 180;
    const Eigen::Vector3d entry(6e-3, 5e-3, 16e-3), way(std::sin(angle), 0, -std::cos(angle));
    const Eigen::Vector3d end = entry + 10e-3 * way;
    column.block.mill([&](const auto& p) {
        const double along = (p - entry).dot(way);
        return along < 10e-3 && (p - entry - along * way).norm() < 1.2e-3;
    });
    const Figures figures = column.block.figures(0.0);
    EXPECT_EQ(valueOf(figures, "breach.grade"), 0);
    EXPECT_NEAR(valueOf(figures, "plan.angle_error"), 8, 0.7);
    EXPECT_NEAR(valueOf(figures, "plan.entry_error"), 1, 0.15);
    EXPECT_NEAR(valueOf(figures, "plan.tip_error"), (end - Eigen::Vector3d(5e-3, 5e-3, 4e-3)).norm() * 1e3,
                0.4);
    EXPECT_NEAR(valueOf(figures, "plan.wall_distance"), (10e-3 - end.x()) * 1e3, 0.3);
}

TEST(Judge, gatesScalesAndTheTotal) {
    JudgedTask task;
    task.gates = {{.figure_id = "a", .label = "", .limit = 2, .is_most = true},
                  {.figure_id = "a", .label = "", .limit = 4, .is_most = false},
                  {.figure_id = "none", .label = "What nobody measured", .limit = 1, .is_most = true}};
    task.scores = {{.figure_id = "a", .label = "", .worst = 0, .best = 4, .weight = 3},
                   {.figure_id = "b", .label = "B", .worst = 10, .best = 0, .weight = 1},
                   {.figure_id = "b", .label = "free", .worst = 0, .best = 1, .weight = 0}};
    task.weights_version = 7;
    task.weights_hash = "00";
    const Figures figures{{"a", 1, "Alpha", 3, "mm3"}, {"b", 1, "Beta", 2.5, "N"}};
    const Assessment result = judge(task, figures);
    ASSERT_EQ(result.gates.size(), 3u);
    EXPECT_FALSE(result.gates[0].is_passed);
    EXPECT_EQ(result.gates[0].text, "Alpha: 3 mm³; at most 2 mm³ were asked for");
    EXPECT_FALSE(result.gates[1].is_passed);
    EXPECT_FALSE(result.gates[2].is_passed);
    EXPECT_EQ(result.gates[2].text, "What nobody measured was not measured");
    EXPECT_FALSE(result.hasPassed());
    ASSERT_EQ(result.sub_scores.size(), 3u);
    EXPECT_EQ(result.sub_scores[0].score, 0.75);
    EXPECT_EQ(result.sub_scores[1].score, 0.75);
    EXPECT_EQ(result.sub_scores[2].score, 1);
    ASSERT_TRUE(result.total);
    EXPECT_EQ(result.total->score, 0) << "nothing was removed";
    EXPECT_EQ(result.total->weights_version, 7);
    task.gates.clear();
    Figures with_work = figures;
    with_work.push_back({"product.removed_volume", 1, "Removed", 12, "mm3"});
    EXPECT_EQ(judge(task, with_work).total->score, 0.75);
    task.scores[0].weight = task.scores[1].weight = 0;
    EXPECT_FALSE(judge(task, figures).total);
}

// An attempt: how much of the target is gone (%), what of the nerve and of the wall (mm³), and the over-cut
// (mm).
struct Deed {
    const char* name;
    double removed, nerve, wall, overcut;
};

double totalOf(const Deed& deed) {
    JudgedTask task;
    task.gates = {{.figure_id = "target.removed", .label = "", .limit = 80, .is_most = false},
                  {.figure_id = "structure.lost_volume:nerve", .label = "", .limit = 0, .is_most = true},
                  {.figure_id = "container_sides.removed_volume", .label = "", .limit = 1, .is_most = true}};
    task.scores = {{.figure_id = "target.removed", .label = "", .worst = 60, .best = 98, .weight = 2},
                   {.figure_id = "overcut.p95", .label = "", .worst = 1, .best = 0.2, .weight = 2}};
    return judge(task, {{"target.removed", 1, "Target", deed.removed, "percent"},
                        {"structure.lost_volume:nerve", 1, "Nerve", deed.nerve, "mm3"},
                        {"container_sides.removed_volume", 1, "Wall", deed.wall, "mm3"},
                        {"overcut.p95", 1, "Over-cut", deed.overcut, "mm"}})
        .total->score;
}

TEST(Judge, theTotalRanksAttemptsAsATeacherWould) {
    constexpr Deed kDeeds[] = {{"idle", 0, 0, 0, 0},
                               {"rough: all is gone, and the nerve and the wall with it", 100, 2, 5, 0.9},
                               {"timid: half of it", 45, 0, 0, 0.1},
                               {"good", 90, 0, 0.5, 0.4},
                               {"expert", 98, 0, 0, 0.2}};
    double before = -1;
    for (const Deed& deed : kDeeds) {
        EXPECT_GT(totalOf(deed), before) << deed.name;
        before = totalOf(deed);
    }
    EXPECT_EQ(totalOf(kDeeds[0]), 0);
    EXPECT_EQ(totalOf(kDeeds[4]), 1);
    EXPECT_LT(totalOf(kDeeds[2]), kPassMark);
    EXPECT_GE(totalOf({"just passed", 80, 0, 1, 1}), kPassMark);
    EXPECT_LT(totalOf({"all but the nerve", 100, 0.01, 0, 0}), kPassMark);
}

}  // namespace
}  // namespace bonemill
