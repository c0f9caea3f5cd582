#include <algorithm>
#include <cstdio>
#include <fstream>
#include <random>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/rt/clock.h"
#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/core/milling/timed_milling.h"
#include "haptic_server/scans/import/import_volume.h"
#include "haptic_server/surface/mesh/mesher.h"
#include "tests/bench/bench_commands.h"
#include "tests/bench/bench_output.h"
#include "tests/bench/leaf_cells.h"
#include "tests/support/places.h"
#include "tests/support/process.h"
#include "tests/support/whole_densities.h"

namespace bonemill::bench {
namespace {

constexpr int kCuts = 400;
constexpr double kBurrRadius = 1e-3;  // m

struct MeshOptions {
    std::string volume, json;
    double iso = 0;
    int runs = 5;
    bool has_vtk = true;
};

double ms(int64_t ns) {
    return millisecondsOfNs(double(ns));
}
double middleOf(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

struct FullMesh {
    double ms = 0;
    size_t triangles = 0;
};
FullMesh meshAll(const BoneModel& bone) {
    FullMesh full;
    Mesher mesher(bone.volume, bone.lattice);
    const int64_t start = monotonicNowNs();
    mesher.pass([&](NodeMesh&& mesh) { full.triangles += mesh.indices.size() / 3; });
    full.ms = ms(monotonicNowNs() - start);
    return full;
}

// A burr removes bone here and there, and the leaves that it touched are meshed again.
LatencyHistogram meshCuts(BoneModel& bone, size_t& leaves) {
    Mesher mesher(bone.volume, bone.lattice);
    mesher.pass([](NodeMesh&&) {});
    std::vector<LeafId> surface;
    for (LeafId leaf = 0; leaf < bone.lattice.leafCount(); ++leaf)
        if (bone.shell.pointCount(0, leaf) > 0) surface.push_back(leaf);
    TimedMilling milling({.removal_rate = 1e9, .shape = MillingShape::kSubVoxel}, bone.volume, bone.lattice,
                         kBurrRadius);
    std::mt19937 random(1);
    LatencyHistogram per_leaf;
    for (int n = 0; n < kCuts; ++n) {
        const LeafId leaf = surface[random() % surface.size()];
        const IndexBox cells = bone.lattice.cellsOf(leaf);
        const Eigen::Vector3d middle =
            bone.volume.spacing().cwiseProduct((cells.min + cells.max).cast<double>() / 2);
        milling.apply(bone.volume, bone.lattice, bone.shell, middle, -1, 1e-3);
        for (bool is_more = true; is_more;) {
            const int64_t start = monotonicNowNs();
            const Mesher::PassResult pass = mesher.pass([](NodeMesh&&) {}, 1);
            if (pass.read > 0) per_leaf.record(monotonicNowNs() - start);
            leaves += pass.read;
            is_more = pass.pending > 0;
        }
    }
    return per_leaf;
}

void writeRaw(const VoxelVolume& volume, const std::string& path) {
    std::ofstream file(path, std::ios::binary);
    std::vector<Density> row(size_t(volume.dims().x()) + VoxelVolume::kReadSlack);
    for (int k = 0; k < volume.dims().z(); ++k)
        for (int j = 0; j < volume.dims().y(); ++j) {
            volume.readRow({0, j, k}, volume.dims().x(), row.data());
            file.write(reinterpret_cast<const char*>(row.data()),
                       std::streamsize(sizeof(Density)) * volume.dims().x());
        }
}

nlohmann::json runVtk(const BoneModel& bone, int runs) {
    const test::TemporaryFolder folder;
    const std::string raw = folder / "densities.raw";
    writeRaw(bone.volume, raw);
    std::vector<std::string> arguments{"/usr/bin/python3",
                                       test::sourceDir() + "/tests/bench/vtk_flying_edges.py", raw};
    for (int axis = 0; axis < 3; ++axis) arguments.push_back(std::to_string(bone.volume.dims()[axis]));
    for (int axis = 0; axis < 3; ++axis)
        arguments.push_back(number(bone.volume.spacing()[axis] * kPerMillimetre, 9));
    arguments.push_back(std::to_string(bone.volume.iso() - 0.5));  // a voxel is inside from iso on
    arguments.push_back(std::to_string(runs));
    const auto finished = test::run(arguments);
    if (finished.exit_code != 0) throw UserError("VTK's part failed: " + finished.err);
    return nlohmann::json::parse(finished.out);
}

void run(const MeshOptions& o) {
    const RawVolume raw = importVolume(o.volume);
    BoneModel bone(densify(raw, DensityWindow{.low = {}, .high = {}, .iso = o.iso}),
                   Eigen::Vector3i::Constant(kLeafCells), {});
    std::vector<double> ours;
    FullMesh full;
    for (int n = 0; n < o.runs; ++n) {
        full = meshAll(bone);
        ours.push_back(full.ms);
    }
    nlohmann::json json{{"ours_ms", middleOf(ours)}, {"triangles", full.triangles}};
    Table table({"whole surface", "triangles", "ms"});
    table.add({"ours", std::to_string(full.triangles), number(middleOf(ours))});
    if (o.has_vtk) {
        const nlohmann::json vtk = runVtk(bone, o.runs);
        const double vtk_ms = middleOf(vtk["times_ms"].get<std::vector<double>>());
        json["vtk_ms"] = vtk_ms;
        json["vtk_triangles"] = vtk["triangles"];
        json["ratio"] = middleOf(ours) / vtk_ms;
        table.add({"VTK " + vtk["version"].get<std::string>() + " flying edges",
                   std::to_string(vtk["triangles"].get<int>()), number(vtk_ms)});
        table.add({"ratio", "", number(json["ratio"])});
    }
    table.print();
    size_t leaves = 0;
    const LatencyHistogram per_leaf = meshCuts(bone, leaves);
    json["leaf_us"] = microseconds(per_leaf);
    Table cut({"after a cut, us", "leaves", "mean", "p50", "p99", "p99.9", "max"});
    cut.add({"per leaf", std::to_string(leaves)}, per_leaf);
    cut.print();
    writeJson(o.json, json);
}

}  // namespace

void addMeshCommand(CLI::App& app) {
    auto o = std::make_shared<MeshOptions>();
    CLI::App* command =
        app.add_subcommand("mesh", "the whole surface beside VTK's, and leaf by leaf after cuts");
    command->add_option("--volume", o->volume, "any volume that a scene can name")->required();
    command->add_option("--iso", o->iso, "bone surface, in the volume's values")->required();
    command->add_option("--runs", o->runs, "medians of so many")->check(CLI::Range(1, 99));
    command->add_flag("!--no-vtk", o->has_vtk, "without VTK (deploy/install-deps --bench)");
    addJsonOption(*command, o->json);
    command->callback([o] { run(*o); });
}

}  // namespace bonemill::bench
