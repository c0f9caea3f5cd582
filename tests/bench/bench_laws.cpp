// Every contact law slides a ball, and a drill that leans on its rim, over a flat frictionless face askew in
// the voxels, from burrs of half a voxel to burrs of many, for `haptic_bench laws`
// (docs/explanation/laws.md).
//
// The hand is 0.3 mm below the face's surface and moves at 5 mm/s. The figures are: the force along the
// normal in per cent of what a rigid tool on the exact face would be felt with; the force along the face,
// root mean square, in per cent of the normal one (false friction); the spread of the normal force; the
// largest step from tick to tick; and the times of whole ticks.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "haptic_server/lab/accuracy_report/measures.h"
#include "haptic_server/laws/all_laws.h"
#include "haptic_server/recording/statistics/tick_times.h"
#include "haptic_server/scene/tool_build/build_tool.h"
#include "tests/bench/bench_commands.h"
#include "tests/bench/bench_output.h"
#include "tests/support/contact_scene.h"

namespace bonemill::bench {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 1e-3;                              // m, of ball and drill
constexpr double kVoxelsPerRadius[] = {0.5, 1, 2, 4, 8, 16};  // R/h
constexpr double kPressed = 0.3e-3, kSpeed = 5e-3;            // m, m/s
constexpr double kLean = 20 * kDegree;
constexpr int kSettleTicks = 400;
const Vector3d kNormal = Vector3d(0.3, -0.2, 1).normalized();
const Vector3d kAlong = Vector3d(1, 0.35, 0).cross(kNormal).cross(kNormal).normalized();

struct Touch {
    const char* name;
    std::vector<ToolShape> shapes;
    Eigen::Quaterniond rotation;
    double height;  // of the tool point above the face when the tool touches it, m
};

std::vector<Touch> touches() {
    const Eigen::Quaterniond upright = rotationBetween(Vector3d::UnitY(), kNormal);
    // The drill's axis leans along the way; its lower rim touches.
    const Eigen::Quaterniond leaning =
        Eigen::Quaterniond(Eigen::AngleAxisd(kLean, kNormal.cross(kAlong).normalized())) * upright;
    return {{"ball", {SphereShape{{0, 0, 0}, kRadius}}, upright, kRadius},
            {"leaning_drill",
             {CylinderShape{{0, 0, 0}, {0, 6e-3, 0}, kRadius, kEdgeRadius}},
             leaning,
             kRadius * std::sin(kLean)}};
}

struct LawFigures {
    double felt = 0, false_friction = 0, spread = 0, step = 0;  // %, %, %, N
    TickTimes times;
};

LawFigures figuresOf(const std::vector<TickRecord>& records, const Vector3d& normal_W, double rigid) {
    LawFigures figures;
    std::vector<int64_t> times;
    double mean = 0, square = 0, along = 0;
    Vector3d before = Vector3d::Zero();
    const double count = double(records.size() - kSettleTicks);
    for (size_t n = kSettleTicks; n < records.size(); ++n) {
        const Vector3d force(records[n].f_hand_W[0], records[n].f_hand_W[1], records[n].f_hand_W[2]);
        const double normal = force.dot(normal_W);
        mean += normal / count;
        square += normal * normal / count;
        along += (force - normal * normal_W).squaredNorm() / count;
        if (n > kSettleTicks) figures.step = std::max(figures.step, (force - before).norm());
        before = force;
        times.push_back(records[n].compute_ns);
    }
    figures.felt = 100 * mean / rigid;
    figures.spread = 100 * std::sqrt(std::max(0.0, square - mean * mean)) / rigid;
    figures.false_friction = 100 * std::sqrt(along) / rigid;
    figures.times = timesOf(std::move(times));
    return figures;
}

LawFigures slide(Preset preset, const Touch& touch, double voxel) {
    const double way = std::max(2e-3, 3 * voxel);
    const int voxels = int(std::ceil((way + 6e-3 + 6 * voxel) / voxel));
    const Vector3d middle = Vector3d(0.502, 0.497, 0.503) * voxels * voxel;
    const test::ContactScene scene(test::cubeGeometry(voxels, voxel), test::halfSpace(middle, kNormal),
                                   touch.shapes, {.levels = {{presetSettings(preset).shell_factor}}});
    BoneModel bone(VoxelVolume(scene.bone.volume), Eigen::Vector3i::Constant(16),
                   {.levels = {{presetSettings(preset).shell_factor}}});
    FixedTickConfig config;
    config.laws = allLaws();
    config.accuracy = presetSettings(preset);
    config.tool = {&scene.tool, {.radius = kRadius}, 50};
    PosePath path;
    const int ticks = int(way / (kSpeed * config.dt));
    for (int n = -kSettleTicks; n < ticks; ++n) {
        const double s = -way / 2 + kSpeed * config.dt * std::max(0, n);
        // It comes down from just above the face.
        const double down = kPressed * std::min(1.0, (n + kSettleTicks) / 200.0);
        path.push_back({middle + s * kAlong + (touch.height - down) * kNormal, touch.rotation});
    }
    const RunRecords records = runPathTimed(config, bone, path).records;
    const double k = config.gradient.coupling.translation_stiffness, most = config.tool.saturation_force;
    return figuresOf(records, kNormal, most * std::tanh(k * kPressed / most));
}

void compareLaws(const std::string& csv_file) {
    std::ofstream csv;
    if (!csv_file.empty()) csv.open(csv_file);
    csv << "tool,law,voxels_per_radius,felt_percent,false_friction_percent,spread_percent,step_n,p50_us,p99_"
           "us\n";
    Table table(
        {"tool", "law", "R/h", "felt %", "false friction %", "spread %", "step N", "p50 us", "p99 us"});
    for (const Touch& touch : touches())
        for (const Preset preset : allPresets())
            for (const double ratio : kVoxelsPerRadius) {
                const LawFigures f = slide(preset, touch, kRadius / ratio);
                const std::string name(presetName(preset));
                table.add({touch.name, name, number(ratio), number(f.felt), number(f.false_friction),
                           number(f.spread), number(f.step), number(f.times.p50), number(f.times.p99)});
                csv << touch.name << ',' << name << ',' << ratio << ',' << f.felt << ',' << f.false_friction
                    << ',' << f.spread << ',' << f.step << ',' << f.times.p50 << ',' << f.times.p99 << '\n';
            }
    table.print();
    csv.close();
    if (!csv_file.empty() && !csv) throw UserError("--csv " + csv_file + ": cannot be written");
}

}  // namespace

void addLawsCommand(CLI::App& app) {
    auto csv = std::make_shared<std::string>();
    CLI::App* command =
        app.add_subcommand("laws", "every contact law on a flat face, by voxels per burr radius");
    command->add_option("--csv", *csv, "also write the figures to this file");
    command->callback([csv] { compareLaws(*csv); });
}

}  // namespace bonemill::bench
