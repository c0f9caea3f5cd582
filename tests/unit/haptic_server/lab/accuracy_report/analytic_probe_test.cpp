#include "haptic_server/lab/accuracy_report/analytic_probe.h"

#include <gtest/gtest.h>

#include <cmath>

namespace bonemill {
namespace {

TEST(ForceOnSphere, IsTheIntegralOfThePressure) {
    const double kappa = 1e12, radius = 1e-3, depth = 0.2e-3;
    // The plane's rings inside the sphere are summed; their pressure is κ times the depth below the sphere's
    // surface (distance from the plane's point to it), along the line to the centre.
    const double height = radius - depth, edge = std::sqrt(radius * radius - height * height);
    constexpr int kRings = 20000;
    double force = 0;
    for (int n = 0; n < kRings; ++n) {
        const double r = edge * (n + 0.5) / kRings;
        const double to_center = std::hypot(r, height);
        force += kappa * (radius - to_center) * height / to_center * 2 * M_PI * r * edge / kRings;
    }
    EXPECT_NEAR(forceOnSphere(kappa, radius, depth) / force, 1, 1e-6);
    EXPECT_EQ(forceOnSphere(kappa, radius, 0), 0);
    EXPECT_EQ(forceOnSphere(kappa, radius, -1e-3), 0);
}

TEST(ContactWidth, IsThatOfTheForcesDepth) {
    const double depth = 30e-6, radius = 1e-3;
    const double width = contactWidth(1e12, radius, forceOnSphere(1e12, radius, depth));
    EXPECT_NEAR(width, 2 * std::sqrt(radius * radius - (radius - depth) * (radius - depth)), 1e-9);
}

TEST(DepthUnderSpring, BalancesTheSaturatingSpring) {
    FixedTickConfig tick;
    tick.tool.saturation_force = 6;
    for (const double device_depth : {0.05e-3, 0.5e-3, 2e-3, 10e-3}) {
        const double depth = depthUnderSpring(tick, device_depth);
        const double spring =
            6 * std::tanh(tick.gradient.coupling.translation_stiffness * (device_depth - depth) / 6);
        EXPECT_NEAR(forceOnSphere(tick.gradient.contact.stiffness_per_area, 1e-3, depth) / spring, 1, 1e-6)
            << device_depth;
    }
}

AnalyticProbeConfig configOf(double spacing) {
    AnalyticProbeConfig config;
    config.spacing = spacing;
    config.sdf_spacing = 0.125e-3;
    config.refinements = {4};
    config.shell_factors = {1, 3};
    return config;
}

// It has one sample per contact point: more would make the voxels' size count for nothing.
AccuracySettings pointsOnly() {
    AccuracySettings settings = presetSettings(Preset::kExact);
    settings.sample_spacing = 0;
    return settings;
}

TEST(AnalyticProbe, FinerVoxelsComeNearerToTheClosedForm) {
    const AccuracySettings exact = pointsOnly();
    AnalyticProbe coarse(configOf(0.2e-3)), fine(configOf(0.05e-3));
    const PlaneErrors a = coarse.measure(exact), b = fine.measure(exact);
    EXPECT_LT(b.force, 1e-3);
    EXPECT_LT(b.depth, 0.3e-6);
    EXPECT_LT(b.force, a.force / 3);
    EXPECT_LT(b.anisotropy, a.anisotropy / 3);
    // The spread over 20 grids is a few standard deviations.
    for (const PlaneErrors& errors : {a, b}) {
        EXPECT_GT(errors.anisotropy, errors.force);
        EXPECT_LT(errors.anisotropy, 15 * errors.force);
    }
}

TEST(AnalyticProbe, CoarserShellsAreWorse) {
    AnalyticProbe probe(configOf(0.125e-3));
    AccuracySettings coarse = pointsOnly();
    coarse.shell_factor = 3;
    EXPECT_GT(probe.measure(coarse).force, 3 * probe.measure(pointsOnly()).force);
    EXPECT_LT(probe.measure(presetSettings(Preset::kExact)).force, 1e-4);
}

TEST(AnalyticProbe, AToolWithoutShapesIsMeasuredOnItsGrid) {
    AnalyticProbeConfig config = configOf(0.125e-3);
    AccuracySettings settings = presetSettings(Preset::kBalanced);
    const double analytic = AnalyticProbe(config).measure(settings).force;
    config.has_analytic_tool = false;
    const double mesh = AnalyticProbe(config).measure(settings).force;
    settings.tool_distance = ToolDistance::kGrid;
    EXPECT_EQ(mesh, AnalyticProbe(config).measure(settings).force);
    EXPECT_GT(mesh, 2 * analytic);
}

TEST(AnalyticProbe, PatchErrorsFallWithThePatchsWidth) {
    const std::vector<PatchErrors> patches = AnalyticProbe(configOf(0.125e-3)).patchErrors();
    const auto at = [&](double width, int factor, double spacing, ToolDistance tool, int refinement = 1) {
        for (const PatchErrors& p : patches)
            if (p.width_voxels == width && p.shell_factor == factor && p.tool_distance == tool &&
                (tool == ToolDistance::kAnalytic || p.sdf_refinement == refinement) &&
                p.sample_spacing == spacing)
                return p;
        ADD_FAILURE() << "no such patch";
        return PatchErrors{};
    };
    constexpr ToolDistance kAnalytic = ToolDistance::kAnalytic, kGrid = ToolDistance::kGrid;
    const double kFine = presetSettings(Preset::kExact).sample_spacing;
    const PatchErrors small = at(2, 1, 0, kAnalytic), large = at(10, 1, 0, kAnalytic);
    EXPECT_LT(large.force_rms, small.force_rms / 10);
    EXPECT_LT(large.force_rms, 5e-3);
    EXPECT_LT(large.direction_rms, small.direction_rms);
    EXPECT_GE(small.force_worst, small.force_rms);
    EXPECT_LT(at(2, 1, kFine, kAnalytic).force_rms, small.force_rms / 3);
    EXPECT_GT(at(10, 3, 0, kAnalytic).force_rms, large.force_rms);
    EXPECT_GT(at(10, 1, kFine, kGrid).force_rms, at(10, 1, kFine, kGrid, 4).force_rms);
    // Returns the depth of a circle of 10 voxels' diameter.
    EXPECT_NEAR(large.depth, 1e-3 - std::sqrt(1e-6 - 0.625e-3 * 0.625e-3), 1e-12);
}

}  // namespace
}  // namespace bonemill
