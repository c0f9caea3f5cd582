#include "haptic_server/cases/casework/case_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/grid_scan.h"

namespace bonemill {
namespace {

const Eigen::Vector3d kBall(50e-3, 60e-3, 40e-3);
constexpr double kRadius = 20e-3;

// A ball of bone in air, and a small one beside it.
RawVolume ballInAir() {
    VolumeGeometry grid;
    grid.dims = {100, 110, 60};
    grid.spacing = {1e-3, 1e-3, 1.5e-3};
    return scanOf(grid, [](const Eigen::Vector3d& p) {
        const double d =
            std::min((p - kBall).norm() - kRadius, (p - Eigen::Vector3d(90e-3, 100e-3, 80e-3)).norm() - 4e-3);
        return std::round(std::clamp(300 - 600 * d / 1e-3, -1000.0, 1500.0));
    });
}

CaseRequest requestAt(std::vector<double> at_mm) {
    CaseRequest request;
    request.iso = 300;
    request.at_mm = std::move(at_mm);
    request.size_mm = 20;
    return request;
}

TEST(CasePlan, BringsTheHandFromOutsideOntoTheBone) {
    const CasePlan plan = planCase(ballInAir(), requestAt({68, 60, 40}));
    EXPECT_TRUE(plan.outwards.isApprox(Eigen::Vector3d::UnitX(), 1e-2));
    EXPECT_LT((plan.start - (kBall + Eigen::Vector3d(kRadius, 0, 0))).norm(), 1e-3);
    ASSERT_TRUE(plan.region);
    EXPECT_TRUE(plan.region->min().isApprox(Eigen::Vector3d(58e-3, 50e-3, 30e-3)));
    EXPECT_TRUE(plan.region->max().isApprox(Eigen::Vector3d(78e-3, 70e-3, 50e-3)));
}

TEST(CasePlan, TakesTheWayThatIsAskedFor) {
    CaseRequest request = requestAt({65, 60, 50});
    request.from_mm = {65, 60, 150};
    const CasePlan plan = planCase(ballInAir(), request);
    EXPECT_TRUE(plan.outwards.isApprox(Eigen::Vector3d::UnitZ()));
    const double up = std::sqrt(20.0 * 20 - 15 * 15);
    EXPECT_LT((plan.start - Eigen::Vector3d(65e-3, 60e-3, (40 + up) * 1e-3)).norm(), 1.5e-3);
}

TEST(CasePlan, WithoutAPlaceIsOfAllBone) {
    const CasePlan plan = planCase(ballInAir(), requestAt({}));
    EXPECT_FALSE(plan.region);
    EXPECT_LT((plan.start - (kBall + Eigen::Vector3d(0, 0, kRadius))).norm(), 1.5e-3) << "from above";
    EXPECT_NE(plan.remarks[0].find("piece 1: 22"), std::string::npos) << plan.remarks[0];
}

TEST(CasePlan, LooksAtNoPieceThatIsDropped) {
    CaseRequest request = requestAt({});
    request.drop_pieces = {1};
    const CasePlan plan = planCase(ballInAir(), request);
    EXPECT_LT((plan.start - Eigen::Vector3d(90e-3, 100e-3, 84e-3)).norm(), 1.5e-3) << "on the small ball";
    request.drop_pieces = {1, 2};
    expectUserError([&] { planCase(ballInAir(), request); }, {"drops all bone"});
    request.drop_pieces = {9};
    expectUserError([&] { planCase(ballInAir(), request); }, {"--drop-piece 9", "only 2 pieces"});
    request = requestAt({90, 100, 80});
    request.drop_pieces = {2};
    expectUserError([&] { planCase(ballInAir(), request); }, {"no bone at --at"});
}

TEST(CasePlan, RefusesAPlaceWithoutBone) {
    expectUserError(
        [] {
            planCase(ballInAir(), requestAt({20, 10, 10}));
        },
        {"no bone at --at", "the bone's middle is"});
    CaseRequest high = requestAt({});
    high.iso = 1400;
    EXPECT_NO_THROW(planCase(ballInAir(), high));
}

// A clip beside the ball is a piece of its own; a screw in the ball is none.
TEST(CasePlan, SaysWhatToDoAboutMetal) {
    RawVolume scan = ballInAir();
    const auto said = [](const CasePlan& plan, const std::string& words) {
        return std::ranges::any_of(
            plan.remarks, [&](const std::string& remark) { return remark.find(words) != std::string::npos; });
    };
    EXPECT_FALSE(said(planCase(scan, requestAt({})), "metal"));
    scan.is_hounsfield = true;
    const auto withMetalAt = [&](const Eigen::Vector3d& at) {
        RawVolume with = scan;
        std::vector<float> values;
        forEachIndex({Eigen::Vector3i::Zero(), scan.geometry.dims.array() - 1},
                     [&](const Eigen::Vector3i& v) {
                         const bool is_metal = (placeOfVoxel(scan.geometry, v) - at).norm() < 3.2e-3;
                         values.push_back(is_metal ? 3071 : scan.values[indexOf(scan.geometry, v)]);
                     });
        with.values = {};
        with.values.append(std::span<const float>(values));
        return planCase(with, requestAt({}));
    };
    const CasePlan clip = withMetalAt({20e-3, 20e-3, 20e-3});
    EXPECT_TRUE(said(clip, "piece 3 is metal: --drop-piece 3"));
    EXPECT_EQ(clip.metal.pieces.size(), 1u);
    const CasePlan screw = withMetalAt(kBall + Eigen::Vector3d(18e-3, 0, 0));
    EXPECT_TRUE(said(screw, "metal is joined to the bone of piece 1"));
    EXPECT_FALSE(said(screw, "is metal: --drop-piece"));
}

TEST(CaseLabels, AreReadFromWords) {
    const std::vector<CaseLabel> labels = labelsOf({"1=sinus:protected", "7=caries:target", "2=a=b"});
    ASSERT_EQ(labels.size(), 3u);
    EXPECT_EQ(labels[0].name, "sinus");
    EXPECT_EQ(labels[0].role, CaseLabel::Role::kProtected);
    EXPECT_EQ(labels[1].labels, std::vector<uint32_t>{7});
    EXPECT_EQ(labels[1].role, CaseLabel::Role::kTarget);
    EXPECT_EQ(labels[2].name, "a=b");
    EXPECT_EQ(labels[2].role, CaseLabel::Role::kPlain);
    for (const char* const word : {"=x", "1=", "1=:protected", "70000=x", "-1=x", "1x=y", ""})
        expectUserError([&] { labelsOf({word}); }, {"--label"});
    EXPECT_TRUE(labelsOf({"facial nerve:protected"})[0].labels.empty());
    expectUserError([] { labelsOf({"1=x", "1=y"}); }, {"given before"});
    expectUserError([] { labelsOf({"1=x", "2=x:protected"}); }, {"given before"});
}

}  // namespace
}  // namespace bonemill
