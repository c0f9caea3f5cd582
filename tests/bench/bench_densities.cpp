#include <time.h>

#include <cmath>

#include "common/base/units.h"
#include "common/density_codec/density_codec.h"
#include "haptic_server/scene/setup/scene_setup.h"
#include "haptic_server/surface/density_stream/density_source.h"
#include "tests/bench/bench_commands.h"
#include "tests/bench/bench_output.h"
#include "tests/support/places.h"

namespace bonemill::bench {
namespace {

constexpr int kEdge = DensitySource::kBrickVoxels;
constexpr double kCut_m = 4e-3;  // radius of what is milled

struct DensitiesOptions {
    std::vector<std::string> scenes;
    std::string json;
};

// Other processes' load is not in it.
double threadTime_us() {
    timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return double(now.tv_sec) * 1e6 + double(now.tv_nsec) * 1e-3;
}

struct Coded {
    size_t bricks = 0, bytes = 0, largest = 0;
    size_t material_bytes = 0;         // beside `bytes`
    double write_us = 0, read_us = 0;  // in all, materials left out
};

Coded codeScanned(const DensitySource& source, DensityEncoder& encoder, size_t& air) {
    Coded coded;
    DensityDecoder decoder;
    const std::string air_bits = source.airBits();
    for (uint32_t brick = 0; brick < source.brickCount(); ++brick) {
        if (uint8_t(air_bits[brick / 8]) >> brick % 8 & 1) {
            ++air;
            continue;
        }
        const double start = threadTime_us();
        const std::string bytes = encoder.scanned(source.scanned(brick), kEdge);
        const double written = threadTime_us();
        decoder.scanned(bytes, kEdge);
        coded.read_us += threadTime_us() - written;
        coded.write_us += written - start;
        ++coded.bricks;
        coded.bytes += bytes.size();
        coded.material_bytes += encoder.materials(source.materials(brick)).size();
        coded.largest = std::max(coded.largest, bytes.size());
    }
    return coded;
}

// Makes a ball of air in the middle of the volume.
void mill(BoneModel& bone) {
    const Eigen::Vector3i middle = bone.volume.dims() / 2;
    const Eigen::Vector3i reach =
        (Eigen::Array3d::Constant(kCut_m) / bone.volume.spacing().array()).ceil().cast<int>();
    const IndexBox box = IndexBox{middle - reach, middle + reach}.clamped(Eigen::Vector3i::Zero(),
                                                                          bone.volume.dims().array() - 1);
    bone.lattice.beginWrite(box);
    bone.volume.openBricksIn(box);
    forEachIndex(box, [&](const Eigen::Vector3i& v) {
        const Eigen::Array3d away = (v - middle).cast<double>().array() * bone.volume.spacing().array();
        const Density air = 0;
        if (away.matrix().norm() < kCut_m) bone.volume.writeRow(v, 1, &air);
    });
    bone.lattice.endWrite(box);
}

Coded codeChanges(const DensitySource& source, DensityEncoder& encoder) {
    Coded coded;
    for (uint32_t brick = 0; brick < source.brickCount(); ++brick) {
        if (source.revision(brick) == 0u) continue;
        const double start = threadTime_us();
        const std::string bytes = encoder.change(source.scanned(brick), source.present(brick)->densities);
        if (bytes.empty()) continue;
        coded.write_us += threadTime_us() - start;
        ++coded.bricks;
        coded.bytes += bytes.size();
        coded.largest = std::max(coded.largest, bytes.size());
    }
    return coded;
}

void run(const DensitiesOptions& options) {
    Table table({"scene", "voxels", "of it MB", "bricks sent", "air", "coded MB", "of those bricks", "mean B",
                 "largest B", "materials B", "coding us", "decoding us", "changed", "mean B", "us"});
    nlohmann::json json;
    for (const std::string& file : options.scenes) {
        const LoadedScene loaded = loadScene(file);
        SceneSetup simulation = setUpScene(loaded);
        BoneHistory history(*simulation.bone);
        const DensitySource source(*simulation.bone, history, simulation.tick.effects.properties.get());
        DensityEncoder encoder(uint16_t(
            std::lround(std::clamp(simulation.mapping.high - simulation.mapping.low, 1.0, 65535.0))));
        size_t air = 0;
        const Coded scanned = codeScanned(source, encoder, air);
        mill(*simulation.bone);
        const Coded changes = codeChanges(source, encoder);
        const Eigen::Vector3i& n = source.geometry().dims;
        const auto per = [](double sum, const Coded& coded) {
            return sum / double(std::max<size_t>(coded.bricks, 1));
        };
        const double sent = double(scanned.bricks) * kEdge * kEdge * kEdge * 2;
        table.add({loaded.scene.name(),
                   std::to_string(n.x()) + "x" + std::to_string(n.y()) + "x" + std::to_string(n.z()),
                   number(double(source.geometry().voxelCount()) * 2e-6), std::to_string(scanned.bricks),
                   std::to_string(air), number(double(scanned.bytes) * 1e-6),
                   number(double(scanned.bytes) / sent, 3), number(per(double(scanned.bytes), scanned)),
                   std::to_string(scanned.largest), number(per(double(scanned.material_bytes), scanned), 3),
                   number(per(scanned.write_us, scanned), 3), number(per(scanned.read_us, scanned), 3),
                   std::to_string(changes.bricks), number(per(double(changes.bytes), changes), 3),
                   number(per(changes.write_us, changes), 3)});
        json[loaded.scene.name()] = {{"bricks", scanned.bricks},
                                     {"air_bricks", air},
                                     {"bytes", scanned.bytes},
                                     {"material_bytes", scanned.material_bytes},
                                     {"coding_us", per(scanned.write_us, scanned)},
                                     {"decoding_us", per(scanned.read_us, scanned)},
                                     {"changed_bricks", changes.bricks},
                                     {"change_bytes", changes.bytes}};
    }
    table.print();
    writeJson(options.json, json);
}

}  // namespace

void addDensitiesCommand(CLI::App& app) {
    auto options = std::make_shared<DensitiesOptions>();
    for (const char* name : {"tooth_corridor", "pedicle", "skull", "mastoid"})
        options->scenes.push_back(test::sourceDir() + "/deploy/scenes/" + name + ".textproto");
    CLI::App* command = app.add_subcommand("densities", "how the scan's densities are coded for viewers");
    command->add_option("--scene", options->scenes, "scene files");
    addJsonOption(*command, options->json);
    command->callback([options] { run(*options); });
}

}  // namespace bonemill::bench
