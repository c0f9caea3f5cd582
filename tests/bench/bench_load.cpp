#include <cstdio>
#include <memory>

#include "common/rt/clock.h"
#include "haptic_server/core/tick/fixed_tick.h"
#include "haptic_server/scans/densify/densify.h"
#include "haptic_server/scans/import/import_volume.h"
#include "haptic_server/scene/tool_build/build_tool.h"
#include "haptic_server/surface/mesh/mesher.h"
#include "tests/bench/bench_commands.h"
#include "tests/bench/bench_output.h"
#include "tests/bench/leaf_cells.h"
#include "tests/support/scripted_io.h"

namespace bonemill::bench {
namespace {

double msSince(int64_t start_ns) {
    return millisecondsOfNs(double(monotonicNowNs() - start_ns));
}

double mib(size_t bytes) {
    return double(bytes) / (1 << 20);
}

std::unique_ptr<BoneModel> makeBone(const std::string& path, std::optional<double> iso,
                                    nlohmann::json& json) {
    int64_t start = monotonicNowNs();
    std::optional<RawVolume> raw = importVolume(path);
    json["import_ms"] = msSince(start);
    json["import_peak_mib"] = mib(peakResidentBytes());
    json["import_child_peak_mib"] = mib(peakResidentBytesOfChildren());
    start = monotonicNowNs();
    const DensityMapping mapping = chooseMapping(*raw, DensityWindow{.low = {}, .high = {}, .iso = iso});
    VoxelVolume volume = densifyNearBone(std::move(*raw), mapping);
    raw.reset();
    json["densify_ms"] = msSince(start);
    start = monotonicNowNs();
    auto bone = std::make_unique<BoneModel>(std::move(volume), Eigen::Vector3i::Constant(kLeafCells),
                                            ShellConfig{.levels = {{1, ShellNormals::kTrilinear}}});
    json["octree_and_shell_ms"] = msSince(start);
    return bone;
}

// Meshes the whole surface, and mills half a second somewhere on it.
void meshAndMill(BoneModel& bone, nlohmann::json& json) {
    constexpr int kTicks = 500;
    size_t triangles = 0;
    const int64_t start = monotonicNowNs();
    Mesher(bone.volume, bone.lattice).pass([&](NodeMesh&& mesh) { triangles += mesh.indices.size() / 3; });
    json["mesh_ms"] = msSince(start);
    json["triangles"] = triangles;
    Eigen::Vector3d on_surface = Eigen::Vector3d::Zero();
    for (LeafId leaf = 0; leaf < bone.lattice.leafCount(); ++leaf)
        bone.shell.forEachBlock(0, leaf, [&](const ShellBlock& block, uint32_t) {
            on_surface = {block.x[0], block.y[0], block.z[0]};
        });
    constexpr double kInTwentyTicks = 12750 * kDensityCountsPerUnit;  // counts/s: from full to nothing
    TimedMilling milling({.removal_rate = kInTwentyTicks, .shape = MillingShape::kSubVoxel}, bone.volume,
                         bone.lattice, 8 * bone.volume.spacing().maxCoeff());
    uint64_t removed = 0;
    for (int n = 0; n < kTicks; ++n)
        removed += milling.apply(bone.volume, bone.lattice, bone.shell, on_surface, -1, 1e-3).removed_voxels;
    json["milled_voxels"] = removed;
}

void run(const std::string& path, std::optional<double> iso, const std::string& json_path) {
    const int64_t start = monotonicNowNs();
    nlohmann::json json;
    const auto bone = makeBone(path, iso, json);
    const ToolModel tool = buildTool({}).model;
    FixedTick tick({{}, {&tool}, {}}, *bone);
    test::ScriptedIo io(test::straightPath(Pose{}, Eigen::Vector3d::Zero(), 1, 0));
    tick.tick(io);
    json["to_first_tick_ms"] = msSince(start);
    meshAndMill(*bone, json);
    json["bricks_with_memory"] = double(bone->volume.bricks().ownCount());
    json["bricks"] = double(bone->volume.bricks().brickCount());
    const double voxels = double(bone->volume.geometry().voxelCount());
    json["voxels"] = voxels;
    json["resident_bytes_per_voxel"] = double(residentBytes()) / voxels;
    json["peak_bytes_per_voxel"] = double(peakResidentBytes()) / voxels;
    json["peak_mib"] = mib(peakResidentBytes());
    json["shell_points"] = bone->shell.pointCount(0);
    Table table({"", ""});
    for (const auto& [key, value] : json.items()) table.add({key, number(value.get<double>(), 6)});
    table.print();
    writeJson(json_path, json);
}

}  // namespace

void addLoadCommand(CLI::App& app) {
    struct Options {
        std::string file, json;
        double iso = 0;
    };
    auto o = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("load", "from a scan to the first tick: time and memory");
    command->add_option("file", o->file, "any volume that a scene can name")->required();
    CLI::Option* iso =
        command->add_option("--iso", o->iso, "bone surface; proposed from the data if not given");
    addJsonOption(*command, o->json);
    command->callback(
        [o, iso] { run(o->file, iso->count() > 0 ? std::optional<double>(o->iso) : std::nullopt, o->json); });
}

}  // namespace bonemill::bench
