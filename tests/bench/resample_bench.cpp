// What fine voxels made of a coarse scan are worth: bodies whose surface is known are scanned as a CT does
// it, at 1 x 1 x 1.5 mm with a blur, and resampled as volume.region does it. Prints the error of the surface,
// and of the force on a burr that is pressed into it, before and after.
//
//   resample_bench [--voxel-mm 0.25] [--blur-mm 0.5] [--burr-mm 1.5] [--press-mm 0.3]
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <map>
#include <random>

#include "common/base/units.h"
#include "common/process/run_program.h"
#include "haptic_server/scans/densify/region.h"
#include "haptic_server/surface/mesh/leaf_mesher.h"
#include "tests/support/contact_scene.h"
#include "tests/support/sampled_body.h"
#include "tests/support/whole_densities.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr double kSoft = 40, kBone = 1500, kIso = (kSoft + kBone) / 2;  // HU
constexpr double kHalf = 11e-3;                                         // of the scanned cube, m

struct Options {
    double voxel_mm = 0.25, blur_mm = 0.5, burr_mm = 1.5, press_mm = 0.3;
};

struct NamedBody {
    const char* name;
    AnalyticBody body;
};

std::vector<NamedBody> bodies() {
    Pose askew;
    askew.position = Vector3d(0.13e-3, -0.21e-3, 0.17e-3);
    askew.rotation = Eigen::AngleAxisd(0.5, Vector3d(1, 2, 3).normalized());
    return {
        {"ball of 6 mm radius", {.kind = BodyKind::kSphere, .radius = 6e-3, .X_WB = askew}},
        {"ball of 3 mm radius", {.kind = BodyKind::kSphere, .radius = 3e-3, .X_WB = askew}},
        {"hole of 3 mm radius", {.kind = BodyKind::kHole, .radius = 3e-3, .thickness = 5e-3, .X_WB = askew}},
        {"edge of 70 deg", {.kind = BodyKind::kWedge, .angle = 70 * kDegree, .X_WB = askew}},
        {"wall of 2 mm", {.kind = BodyKind::kThinWall, .thickness = 2e-3, .X_WB = askew}},
        {"wall of 1 mm", {.kind = BodyKind::kThinWall, .thickness = 1e-3, .X_WB = askew}}};
}

VolumeGeometry gridOf(const Vector3d& spacing) {
    VolumeGeometry grid;
    grid.spacing = spacing;
    grid.dims = (2 * kHalf / spacing.array()).ceil().cast<int>() + 1;
    grid.X_WV.position.setConstant(-kHalf);
    return grid;
}

// What a scanner gives: the share of bone in a voxel, seen through a Gaussian blur, and through the slice's
// thickness.
RawVolume scanned(const AnalyticBody& body, double blur) {
    const VolumeGeometry grid = gridOf(Vector3d(1, 1, 1.5) * kMillimetre);
    std::mt19937 random(5);
    std::normal_distribution<double> gauss(0, blur);
    std::uniform_real_distribution<double> slice(-0.75e-3, 0.75e-3);
    std::vector<Vector3d> around(4000);
    for (Vector3d& p : around) p = Vector3d(gauss(random), gauss(random), gauss(random) + slice(random));
    RawVolume scan;
    scan.geometry = grid;
    std::vector<float> values;
    forEachIndex({Eigen::Vector3i::Zero(), grid.dims.array() - 1}, [&](const Eigen::Vector3i& v) {
        const Vector3d p = grid.X_WV * Vector3d(grid.spacing.cwiseProduct(v.cast<double>()));
        const double d = signedDistance(body, p);
        const double reach = 4 * blur + 0.75e-3;
        double share = d < 0 ? 1 : 0;
        if (std::abs(d) < reach)
            share = double(std::ranges::count_if(
                        around, [&](const Vector3d& o) { return signedDistance(body, p + o) < 0; })) /
                    double(around.size());
        values.push_back(float(std::round(kSoft + share * (kBone - kSoft))));
    });
    scan.values.append(std::span<const float>(values));
    return scan;
}

VoxelVolume dense(const RawVolume& raw) {
    return densify(raw, DensityWindow{.low = kSoft - 500, .high = kBone + 500, .iso = kIso});
}

// Of the surface's points, spread evenly over it and away from the cube's faces.
std::vector<double> surfaceErrors(const VoxelVolume& volume, const AnalyticBody& body) {
    const LeafLattice lattice(volume, Eigen::Vector3i::Constant(16));
    std::mt19937 random(9);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<double> errors;
    for (LeafId leaf = 0; leaf < lattice.leafCount(); ++leaf) {
        const NodeMesh mesh = LeafMesher(volume, lattice).mesh(leaf).value();
        const auto at = [&](uint32_t index) {
            const PackedVertex& v = mesh.vertices[index];
            return Vector3d(
                (mesh.origin + mesh.step.cwiseProduct(Eigen::Vector3f(v.x, v.y, v.z))).cast<double>());
        };
        for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            const Vector3d a = at(mesh.indices[i]), b = at(mesh.indices[i + 1]), c = at(mesh.indices[i + 2]);
            const double points = 20 * (b - a).cross(c - a).norm() / 2 / 1e-6;  // 20 per mm²
            for (double n = uniform(random); n < points; ++n) {
                const double u = std::sqrt(uniform(random)), v = uniform(random);
                const Vector3d p =
                    volume.geometry().X_WV * Vector3d((1 - u) * a + u * (1 - v) * b + u * v * c);
                if (p.cwiseAbs().maxCoeff() < kHalf - 2e-3)
                    errors.push_back(std::abs(signedDistance(body, p)));
            }
        }
    }
    return errors;
}

// The burr's centre over places of the true surface, so that it is pressed in by so much.
std::vector<Vector3d> burrPlaces(const AnalyticBody& body, double radius, double press) {
    std::mt19937 random(17);
    std::uniform_real_distribution<double> uniform(-kHalf + 5e-3, kHalf - 5e-3);
    std::vector<Vector3d> places;
    while (places.size() < 200) {
        Vector3d p(uniform(random), uniform(random), uniform(random));
        const auto slope = [&](const Vector3d& q) {
            Vector3d g;
            for (int axis = 0; axis < 3; ++axis)
                g[axis] = signedDistance(body, q + 1e-6 * Vector3d::Unit(axis)) -
                          signedDistance(body, q - 1e-6 * Vector3d::Unit(axis));
            return Vector3d(g.normalized());
        };
        const double wanted = radius - press;
        for (int step = 0; step < 30; ++step) p -= (signedDistance(body, p) - wanted) * slope(p);
        if (std::abs(signedDistance(body, p) - wanted) < 1e-7 && p.cwiseAbs().maxCoeff() < kHalf - 4e-3)
            places.push_back(p);
    }
    return places;
}

std::vector<Vector3d> forces(const VoxelVolume& volume, const std::vector<Vector3d>& burrs_W, double radius) {
    const BoneModel bone(volume, Eigen::Vector3i::Constant(16), {});
    const std::vector<ToolShape> shapes{SphereShape{Vector3d::Zero(), radius}};
    const ToolModel tool(test::gridOf(shapes), shapes, radius);
    const AccuracySettings settings;
    const ToolField& field = tool.field(settings);
    std::vector<Vector3d> all;
    for (const Vector3d& burr_W : burrs_W) {
        const Pose X_VT{volume.geometry().X_WV.inverse() * burr_W, Eigen::Quaterniond::Identity()};
        GradientContact contact({.stiffness_cap = 1e12});
        contact.gather({bone.volume, bone.lattice, bone.shell, levelOf(bone.shell, settings),
                        settings.sample_spacing, settings.most_samples},
                       field, X_VT, 0.2e-3);
        all.push_back(contact.evaluate<double>(field, X_VT).term.wrench.force);
    }
    return all;
}

struct Spread {
    double mean = 0, p99 = 0;
};

Spread spreadOf(std::vector<double> values) {
    if (values.empty()) return {NAN, NAN};
    std::ranges::sort(values);
    double sum = 0;
    for (const double v : values) sum += v;
    return {sum / double(values.size()),
            values[std::min(values.size() - 1, size_t(0.99 * double(values.size())))]};
}

// Percent of the true force; where that is next to nothing it is left out.
std::vector<double> forceErrors(const std::vector<Vector3d>& found, const std::vector<Vector3d>& truth) {
    std::vector<double> errors;
    for (size_t n = 0; n < truth.size(); ++n)
        if (truth[n].norm() > 1e-3) errors.push_back(100 * (found[n] - truth[n]).norm() / truth[n].norm());
    return errors;
}

void measure(const NamedBody& named, const Options& options) {
    const RawVolume scan = scanned(named.body, options.blur_mm * kMillimetre);
    const Eigen::AlignedBox3d all(Vector3d::Constant(-kHalf), Vector3d::Constant(kHalf));
    const RawVolume fine = resampleRegion(
        scan, regionGeometry(scan.geometry, all, options.voxel_mm * kMillimetre), scan.values.range());
    const RawVolume sharp =
        resampleRegion(scan, fine.geometry, scan.values.range(), options.blur_mm * kMillimetre);
    const VoxelVolume before = dense(scan), after = dense(fine), deblurred = dense(sharp);
    const VoxelVolume truth = [&] {
        RawVolume exact = sampleBody(named.body, gridOf(Vector3d::Constant(0.1e-3)), 65535);
        return densify(exact, DensityWindow{.low = 0, .high = 65535, .iso = 65535 / 2.0});
    }();
    const double radius = options.burr_mm * kMillimetre;
    const std::vector<Vector3d> burrs = burrPlaces(named.body, radius, options.press_mm * kMillimetre);
    const std::vector<Vector3d> true_forces = forces(truth, burrs, radius);
    const auto row = [&](const char* what, const VoxelVolume& volume) {
        const Spread surface = spreadOf(surfaceErrors(volume, named.body));
        const Spread force = spreadOf(forceErrors(forces(volume, burrs, radius), true_forces));
        std::printf("| %s | %s | %.3f | %.3f | %.1f | %.1f |\n", named.name, what,
                    surface.mean * kPerMillimetre, surface.p99 * kPerMillimetre, force.mean, force.p99);
        std::fflush(stdout);
    };
    row("as scanned", before);
    row("resampled", after);
    row("resampled, deblurred", deblurred);
}

int run(int argc, char** argv) {
    Options options;
    CLI::App app("What fine voxels made of a coarse scan are worth", "resample_bench");
    app.add_option("--voxel-mm", options.voxel_mm)->capture_default_str();
    app.add_option("--blur-mm", options.blur_mm, "standard deviation")->capture_default_str();
    app.add_option("--burr-mm", options.burr_mm, "radius")->capture_default_str();
    app.add_option("--press-mm", options.press_mm, "into the true surface")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    std::printf(
        "scanned at 1 x 1 x 1.5 mm with a blur of %.2f mm, resampled to %.2f mm; burr of %.1f mm, pressed in "
        "by %.2f mm\n",
        options.blur_mm, options.voxel_mm, options.burr_mm, options.press_mm);
    std::printf(
        "| body | voxels | surface error, mean (mm) | p99 | force error, mean (%%) | p99 "
        "|\n|---|---|--:|--:|--:|--:|\n");
    for (const NamedBody& named : bodies()) measure(named, options);
    return 0;
}

}  // namespace
}  // namespace bonemill

int main(int argc, char** argv) {
    return bonemill::runProgram([&] { return bonemill::run(argc, argv); });
}
