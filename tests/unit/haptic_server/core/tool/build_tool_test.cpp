#include "haptic_server/scene/tool_build/build_tool.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/base/user_error.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/core/tool/mesh_test_support.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

std::string joined(const std::vector<std::string>& warnings) {
    std::string all;
    for (const std::string& warning : warnings) all += warning + "\n";
    return all;
}

void expectRefused(const ToolConfig& config, const std::string& words) {
    try {
        buildTool(config);
        ADD_FAILURE() << "accepted, expected: " << words;
    } catch (const UserError& e) {
        EXPECT_EQ(std::string(e.what()).find("tool"), 0u) << e.what();
        EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
    }
}

template <class Visit>
void forEachNode(const SdfGrid& sdf, Visit&& visit) {
    for (int k = 0; k < sdf.nodes().z(); ++k)
        for (int j = 0; j < sdf.nodes().y(); ++j)
            for (int i = 0; i < sdf.nodes().x(); ++i) visit(sdf.nodePosition(i, j, k), sdf.at(i, j, k));
}

// These are the demo tool's own formulas: it has a burr of 1 mm and an endless shaft of 0.8 mm.
double demoTool(const Vector3d& p) {
    const double shaft = std::hypot(p.x(), p.z(), std::min(p.y(), 0.0)) - 0.8e-3;
    return std::min(p.norm() - 1e-3, shaft);
}

TEST(BuildTool, DemoToolFitsItsGrid) {
    const BuiltTool tool = buildTool({});
    EXPECT_EQ(joined(tool.warnings), "");
    EXPECT_EQ(tool.model.grid().nodes(), Eigen::Vector3i(22, 128, 22));
    EXPECT_EQ(tool.model.grid().spacing(), 0.125e-3);
    EXPECT_NEAR(tool.model.grid().origin().y(), -1e-3 - 3 * 0.125e-3, 1e-15);
    EXPECT_NEAR(tool.model.grid().gridBox().center().x(), 0, 1e-15);
    EXPECT_NEAR(tool.model.grid().gridBox().center().z(), 0, 1e-15);
    EXPECT_EQ(tool.model.grid().box().max().y(),
              tool.model.grid().gridBox().max().y());  // the shaft leaves at the far end
}

TEST(BuildTool, DemoToolIsExactAtNodes) {
    forEachNode(buildTool({}).model.grid(),
                [](const Vector3d& p, float value) { ASSERT_FLOAT_EQ(value, float(demoTool(p))); });
}

TEST(BuildTool, DemoToolIsOfSecondOrderBetweenNodes) {
    const SdfGrid sdf = buildTool({}).model.grid();
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(0, 1);
    int checked = 0;
    for (int n = 0; n < 50000; ++n) {
        const Vector3d t(unit(random), unit(random), unit(random));
        const Vector3d p = sdf.gridBox().min() + t.cwiseProduct(sdf.gridBox().sizes());
        const double burr = p.norm() - 1e-3, shaft = std::hypot(p.x(), p.z(), std::min(p.y(), 0.0)) - 0.8e-3;
        const double r =
            std::min({p.norm(), std::hypot(p.x(), p.z()), 1e-3}) - std::sqrt(3.0) * sdf.spacing();
        // Places near the crease between burr and shaft, and near the axis, are left out.
        if (std::abs(burr - shaft) < 4 * sdf.spacing() || r < 0.3e-3) continue;
        ++checked;
        ASSERT_NEAR(sdf.distance(p), demoTool(p), sdf.spacing() * sdf.spacing() / (4 * r) + 1e-9)
            << p.transpose();
    }
    EXPECT_GT(checked, 10000);
}

TEST(BuildTool, RotatedCylinderIsExactAtNodes) {
    const Pose X_TS{Vector3d(0.2e-3, -0.4e-3, 0.1e-3), Eigen::Quaterniond(0.9, 0.2, -0.3, 0.25).normalized()};
    ToolConfig config;
    config.shapes = {CylinderShape{X_TS.position, X_TS * Vector3d(0, 4e-3, 0), 0.9e-3}};
    config.sdf_nodes = {40, 50, 40};
    const BuiltTool tool = buildTool(config);
    const Pose X_ST = X_TS.inverse();
    int inside = 0;
    forEachNode(tool.model.grid(), [&](const Vector3d& p, float value) {
        const Vector3d p_S = X_ST * p;
        const Eigen::Vector2d beyond(std::hypot(p_S.x(), p_S.z()) - 0.9e-3, std::abs(p_S.y() - 2e-3) - 2e-3);
        const double expected = beyond.cwiseMax(0).norm() + std::min(beyond.maxCoeff(), 0.0);
        inside += value < 0;
        ASSERT_NEAR(value, expected, 1e-9);
    });
    const double volume = inside * std::pow(tool.model.grid().spacing(), 3);
    EXPECT_NEAR(volume, std::numbers::pi * 0.9e-3 * 0.9e-3 * 4e-3, 0.03 * volume);
}

TEST(BuildTool, UnionIsTheNearestShape) {
    ToolConfig config;
    const SphereShape burr{Vector3d::Zero(), 1e-3};
    const ConeShape neck{{0, 0, 0}, {0, 5e-3, 0}, 0.4e-3, 0.9e-3};
    config.shapes = {burr, neck};
    forEachNode(buildTool(config).model.grid(), [&](const Vector3d& p, float value) {
        ASSERT_EQ(value, float(std::min(signedDistance(burr, p), signedDistance(neck, p))));
    });
}

TEST(BuildTool, MeshAndShapeAgree) {
    const test::TemporaryFolder folder;
    const std::string path = folder / "box.stl";
    test::writeBytes(path, test::binaryStl(test::boxSoup({-0.75f, -1, -0.5f}, {0.75f, 12, 0.5f})));
    ToolConfig config;
    config.mesh_path = path;
    config.burr_radius = 0.5e-3;
    const BuiltTool tool = buildTool(config);
    EXPECT_EQ(joined(tool.warnings), "");
    const Vector3d center(0, 5.5e-3, 0), half(0.75e-3, 6.5e-3, 0.5e-3);
    forEachNode(tool.model.grid(), [&](const Vector3d& p, float value) {
        const Vector3d beyond = (p - center).cwiseAbs() - half;
        ASSERT_NEAR(value, beyond.cwiseMax(0).norm() + std::min(beyond.maxCoeff(), 0.0), 1e-9);
    });
}

TEST(BuildTool, GridStandsWhereAsked) {
    ToolConfig config;
    config.sdf_origin_T = Vector3d(-1.4e-3, -1.2e-3, -1.3e-3);
    const BuiltTool tool = buildTool(config);
    EXPECT_EQ(tool.model.grid().origin(), *config.sdf_origin_T);
    EXPECT_EQ(tool.model.grid().box().max().y(), tool.model.grid().gridBox().max().y());
    EXPECT_EQ(joined(tool.warnings), "");
}

TEST(BuildTool, WarnsWhenTheGridCutsTheTool) {
    ToolConfig config;
    config.burr_radius = 1.5125e-3;
    const std::string wide = joined(buildTool(config).warnings);
    EXPECT_NE(wide.find("sticks out of its distance grid by 0.200 mm at the -x side"), std::string::npos)
        << wide;
    EXPECT_NE(wide.find("at the -z side"), std::string::npos) << wide;
    EXPECT_EQ(wide.find("y side"), std::string::npos) << wide;

    config = {};
    config.sdf_origin_T = Vector3d(-1.2e-3, -0.5e-3, -1.3125e-3);
    const std::string burr_cut = joined(buildTool(config).warnings);
    EXPECT_NE(burr_cut.find("by 0.500 mm at the -y side"), std::string::npos) << burr_cut;
    EXPECT_EQ(burr_cut.find("x side"), std::string::npos) << burr_cut;
}

TEST(BuildTool, WarnsOfATinyBurr) {
    ToolConfig config;
    config.burr_radius = 0.24e-3;
    const std::string warnings = joined(buildTool(config).warnings);
    EXPECT_NE(warnings.find("burr_radius_mm 0.240 is below 2 spacings"), std::string::npos) << warnings;
}

TEST(BuildTool, WarnsWhenTheBurrIsElsewhere) {
    ToolConfig config;
    config.shapes = {SphereShape{{0, 3e-3, 0}, 1e-3}};
    const std::string warnings = joined(buildTool(config).warnings);
    EXPECT_NE(warnings.find("origin of frame T"), std::string::npos) << warnings;
}

TEST(BuildTool, RefusesBadConfigs) {
    const auto with = [](auto&& change) {
        ToolConfig config;
        change(config);
        return config;
    };
    expectRefused(with([](ToolConfig& c) { c.burr_radius = -1e-3; }), "burr_radius_mm");
    expectRefused(with([](ToolConfig& c) { c.burr_radius = std::nan(""); }), "burr_radius_mm");
    expectRefused(with([](ToolConfig& c) { c.sdf_spacing = 0; }), "sdf_spacing_mm");
    expectRefused(with([](ToolConfig& c) { c.sdf_nodes.y() = 1; }), "sdf_nodes: 22 x 1 x 22");
    expectRefused(with([](ToolConfig& c) { c.sdf_nodes.setConstant(2000000000); }), "sdf_nodes");
    expectRefused(with([](ToolConfig& c) { c.sdf_origin_T = Vector3d(0, std::nan(""), 0); }),
                  "sdf_origin_mm");
    expectRefused(with([](ToolConfig& c) {
                      c.shapes = {SphereShape{}, SphereShape{{0, 0, 0}, -1}};
                  }),
                  "tool.shape[1]");
    expectRefused(with([](ToolConfig& c) { c.sdf_origin_T = Vector3d(1, 1, 1); }),
                  "no node of its distance grid");
    expectRefused(with([](ToolConfig& c) {
                      c.shapes = {SphereShape{}};
                      c.mesh_path = "burr.stl";
                  }),
                  "both shape and mesh_path");
}

ToolConfig withBurr(BurrKind kind) {
    ToolConfig config;
    config.burr_kind = kind;
    config.burr_length = 3e-3;
    config.burr_tip_radius = 0.3e-3;
    return config;
}

// Nothing of the shaft looks out of the burr's far half, and the tool begins where its burr does.
TEST(BuildTool, IsItsBurrAndAShaftWhereShapesAreNotGiven) {
    for (const BurrKind kind : {BurrKind::kBall, BurrKind::kCylinder, BurrKind::kCone}) {
        const ToolConfig config = withBurr(kind);
        const BuiltTool tool = buildTool(config);
        EXPECT_EQ(joined(tool.warnings), "");
        const ToolField& field = tool.model.field({.tool_distance = ToolDistance::kAnalytic});
        std::mt19937 random(7);
        std::uniform_real_distribution<double> where(-1.6e-3, 1.6e-3);
        for (int n = 0; n < 2000; ++n) {
            const Vector3d p(where(random), where(random), where(random));
            if (p.y() > 0) continue;
            const double burr = config.burr().signedDistance(p);
            // What a rounded edge lacks of a sharp one, at the sharpest of these tools.
            const double lack = config.burr_kind == BurrKind::kBall ? 0 : kEdgeRadius;
            const double distance = field.sample(p).distance;
            if (burr > 0) {
                EXPECT_GE(distance, burr - 1e-9) << p.transpose();
                EXPECT_LE(distance, burr + lack + 1e-9) << p.transpose();
            } else if (burr < 0) {
                EXPECT_LT(distance, lack + 1e-12) << p.transpose();
            }
        }
        const double end = kind == BurrKind::kBall ? config.burr_radius : config.burr_length / 2;
        EXPECT_NEAR(field.box().min().y(), -end, 1e-12);
        EXPECT_LT(field.sample(Vector3d(0, 5e-3, 0)).distance, -0.5e-3);  // the shaft
    }
}

TEST(BuildTool, WarnsOfABurrThatSticksOutOfIt) {
    ToolConfig config = withBurr(BurrKind::kCylinder);
    config.shapes = {CylinderShape{{0, -1.5e-3, 0}, {0, 8e-3, 0}, 1e-3}};
    EXPECT_EQ(joined(buildTool(config).warnings), "");
    config.burr_radius = 1.4e-3;
    EXPECT_NE(joined(buildTool(config).warnings).find("its burr sticks out of it by 0.40"), std::string::npos)
        << joined(buildTool(config).warnings);
}

TEST(BuildTool, RefusesABurrWithoutALength) {
    ToolConfig config = withBurr(BurrKind::kCone);
    config.burr_length = 0;
    expectRefused(config, "burr_length_mm must be a positive number");
}

}  // namespace
}  // namespace bonemill
