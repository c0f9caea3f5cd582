// Writes phantoms: a tooth as a DICOM CT series, blocks, a vertebra, temporal bones, third molars and
// analytic bodies as NRRD. See docs/reference/phantoms.md.
#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <limits>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/cli/command_line.h"
#include "common/files/require_apart.h"
#include "common/process/run_program.h"
#include "haptic_server/apps/make_phantom/anatomic_phantoms.h"
#include "haptic_server/apps/make_phantom/phantom_options.h"
#include "haptic_server/cases/phantom/analytic_body.h"
#include "haptic_server/cases/phantom/tooth_phantom.h"
#include "haptic_server/cases/phantom_dicom/dicom_series_writer.h"
#include "haptic_server/scans/nrrd/nrrd_writer.h"

namespace bonemill {
namespace {

struct ToothArguments {
    std::string folder;
    std::string labels;  // file; empty: none
    ToothScan scan;
};

struct BlockArguments {
    std::string file;
    std::string labels;  // file; empty: none
    std::vector<double> size_mm{20, 20, 10};
    std::vector<std::string> layers{"1500"};
    bool is_shell = false;
    double air_hu = -1000, voxel_mm = 0.125, margin_mm = 1;
};

struct BodyArguments {
    std::string kind;
    std::string file;
    double voxel_mm = 0.25;
    int bits = 16;
    std::vector<int> dims{64, 64, 64};
    std::vector<double> rotate_deg{0, 0, 0};
    std::vector<double> offset_mm{0, 0, 0};
    double radius_mm = 4;
    double thickness_mm = 4;
    double angle_deg = 40;
};

// Writes value_at(position in W) for each voxel.
template <class T, class ValueAt>
void writeGrid(const std::string& file, const VolumeGeometry& grid, ValueAt&& value_at) {
    NrrdStream<T> stream(file, grid);
    std::vector<T> row(size_t(grid.dims.x()));
    for (int k = 0; k < grid.dims.z(); ++k)
        for (int j = 0; j < grid.dims.y(); ++j) {
            for (int i = 0; i < grid.dims.x(); ++i)
                row[size_t(i)] = T(value_at(grid.X_WV * grid.spacing.cwiseProduct(Eigen::Vector3d(i, j, k))));
            stream.append(row);
        }
    stream.close();
    std::cout << "wrote " << file << "\n";
}

void makeTooth(const ToothArguments& arguments) {
    const std::string seed = "bonemill tooth, noise " + std::to_string(arguments.scan.noise_hu) +
                             " HU, seed " + std::to_string(arguments.scan.seed);
    const RawVolume tooth = scanTooth(toothGrid(), arguments.scan);
    writeCtSeries(arguments.folder, tooth, {"PHANTOM^TOOTH", "bonemill tooth phantom", seed});
    std::cout << "wrote " << tooth.geometry.dims.z() << " slices to " << arguments.folder << "\n";
    if (!arguments.labels.empty())
        writeGrid<uint8_t>(arguments.labels, tooth.geometry,
                           [](const Eigen::Vector3d& p_W) { return int(toothTissue(p_W)); });
}

// It reads "THICKNESS_MM:HU", or "HU" for the last one.
BlockLayer layerOf(const std::string& text, bool is_last) {
    const size_t colon = text.find(':');
    const std::string thickness = colon == std::string::npos ? "0" : text.substr(0, colon);
    const std::string hu = colon == std::string::npos ? text : text.substr(colon + 1);
    BlockLayer layer{};
    const bool is_read = CLI::detail::lexical_cast(thickness, layer.thickness) &&
                         CLI::detail::lexical_cast(hu, layer.hu) && std::isfinite(layer.thickness);
    if (!is_read || layer.thickness < 0 || !(layer.hu >= -1024 && layer.hu <= 30000))
        throw UserError("--layers " + text +
                        ": no layer; write THICKNESS_MM:HU, and HU alone for the last one");
    if (!is_last && !(layer.thickness > 0))
        throw UserError("--layers " + text + ": how thick? Only the last layer takes what is left");
    layer.thickness *= kMillimetre;
    return layer;
}

BlockPhantom blockOf(const BlockArguments& arguments) {
    constexpr size_t kMaxLayers = 255;  // labels of 8 bit
    constexpr double kMostVoxels = 1u << 30;
    if (arguments.layers.size() > kMaxLayers) throw UserError("--layers: 255 at most");
    BlockPhantom block;
    block.size = Eigen::Vector3d(arguments.size_mm.data()) * kMillimetre;
    block.layers.clear();
    for (const std::string& text : arguments.layers)
        block.layers.push_back(layerOf(text, block.layers.size() + 1 == arguments.layers.size()));
    block.is_shell = arguments.is_shell;
    block.air_hu = arguments.air_hu;
    block.voxel = arguments.voxel_mm * kMillimetre;
    block.margin = arguments.margin_mm * kMillimetre;
    const Eigen::Vector3d voxels = ((block.size.array() + 2 * block.margin) / block.voxel).matrix();
    if (voxels.prod() > kMostVoxels)
        throw UserError("--size-mm and --voxel-mm: more than 2^30 voxels; take larger ones");
    return block;
}

void makeBlock(const BlockArguments& arguments) {
    const BlockPhantom block = blockOf(arguments);
    requireApart({{"--out", arguments.file}, {"--labels", arguments.labels}}, {});
    const VolumeGeometry grid = block.grid();
    writeGrid<int16_t>(arguments.file, grid,
                       [&](const Eigen::Vector3d& p_W) { return std::lround(block.hu(p_W)); });
    if (!arguments.labels.empty())
        writeGrid<uint8_t>(arguments.labels, grid,
                           [&](const Eigen::Vector3d& p_W) { return int(block.label(p_W)); });
    std::cout << "top face at z = 0, surface at " << (block.air_hu + block.layers.front().hu) / 2 << " HU\n";
}

BodyKind kindOf(const std::string& name) {
    if (name == "slab") return BodyKind::kSlab;
    if (name == "sphere") return BodyKind::kSphere;
    if (name == "hole") return BodyKind::kHole;
    return name == "wedge" ? BodyKind::kWedge : BodyKind::kThinWall;
}

AnalyticBody bodyOf(const BodyArguments& arguments) {
    AnalyticBody body;
    body.kind = kindOf(arguments.kind);
    body.radius = arguments.radius_mm * kMillimetre;
    body.thickness = arguments.thickness_mm * kMillimetre;
    body.angle = arguments.angle_deg * kDegree;
    const auto& r = arguments.rotate_deg;
    body.X_WB.rotation = Eigen::AngleAxisd(r[2] * kDegree, Eigen::Vector3d::UnitZ()) *
                         Eigen::AngleAxisd(r[1] * kDegree, Eigen::Vector3d::UnitY()) *
                         Eigen::AngleAxisd(r[0] * kDegree, Eigen::Vector3d::UnitX());
    body.X_WB.position = Eigen::Vector3d(arguments.offset_mm.data()) * kMillimetre;
    return body;
}

// T is as wide as the file's samples.
template <class T>
void writeBody(const BodyArguments& arguments) {
    const VolumeGeometry grid =
        centredGrid(Eigen::Vector3i(arguments.dims.data()), arguments.voxel_mm * kMillimetre);
    const AnalyticBody body = bodyOf(arguments);
    constexpr double kFull = std::numeric_limits<T>::max();
    NrrdStream<T> file(arguments.file, grid);
    for (int k = 0; k < grid.dims.z(); ++k) {
        const std::vector<float> slice = sampleBodySlice(body, grid, kFull, k);
        file.append(std::vector<T>(slice.begin(), slice.end()));
    }
    file.close();
    std::cout << "wrote " << arguments.file << ", surface at " << kFull / 2 << "\n";
}

void makeBody(const BodyArguments& arguments) {
    arguments.bits == 8 ? writeBody<uint8_t>(arguments) : writeBody<uint16_t>(arguments);
}

template <class T, class Limits>
void addThree(CLI::App& command, const char* name, std::vector<T>& values, const Limits& limits,
              const char* help) {
    command.add_option(name, values, help)->expected(3)->check(limits)->capture_default_str();
}

void addTooth(CLI::App& tooth, ToothArguments& arguments) {
    tooth.add_option("--out", arguments.folder, "folder to write to")->required();
    addNumber(tooth, "--noise-hu", arguments.scan.noise_hu, 0, 500, "standard deviation of the noise");
    addSeed(tooth, arguments.scan.seed, "seed of the noise");
    tooth.add_option("--labels", arguments.labels,
                     "NRRD file to write: 1 pulp, 2 caries, 3 dentine, 4 enamel, 0 none");
}

void addBlock(CLI::App& block, BlockArguments& arguments) {
    block.add_option("--out", arguments.file, "NRRD file to write")->required();
    block.add_option("--labels", arguments.labels, "NRRD file to write: layers from 1, 0 outside");
    addThree(block, "--size-mm", arguments.size_mm, within(0.1, 1e3), "of the block");
    block
        .add_option("--layers", arguments.layers,
                    "from the surface inwards: THICKNESS_MM:HU ..., the last one HU alone")
        ->expected(1, 255)
        ->capture_default_str();
    block.add_flag("--shell", arguments.is_shell, "layers follow all faces, not only the top");
    addNumber(block, "--air-hu", arguments.air_hu, -1024, 30000, "");
    addNumber(block, "--voxel-mm", arguments.voxel_mm, 1e-3, 100, "edge of a voxel");
    addNumber(block, "--margin-mm", arguments.margin_mm, 0, 1e3, "air around the block");
}

void addBody(CLI::App& body, BodyArguments& arguments) {
    body.add_option("--kind", arguments.kind, "slab, sphere, hole, wedge or thin-wall")
        ->required()
        ->check(CLI::IsMember({"slab", "sphere", "hole", "wedge", "thin-wall"}));
    body.add_option("--out", arguments.file, "NRRD file to write")->required();
    addNumber(body, "--voxel-mm", arguments.voxel_mm, 1e-3, 100, "edge of a voxel");
    addNumber(body, "--radius-mm", arguments.radius_mm, 1e-3, 1e4, "sphere and hole");
    addNumber(body, "--thickness-mm", arguments.thickness_mm, 1e-3, 1e4,
              "slab, plate with the hole and thin wall");
    addNumber(body, "--angle-deg", arguments.angle_deg, 1, 179, "full opening angle of the wedge");
    body.add_option("--bits", arguments.bits, "8 or 16")
        ->check(CLI::IsMember({8, 16}))
        ->capture_default_str();
    addThree(body, "--dims", arguments.dims, CLI::Range(2, 1024), "voxels per axis");
    addThree(body, "--rotate-deg", arguments.rotate_deg, within(-360, 360),
             "about x, then y, then z of the world");
    addThree(body, "--offset-mm", arguments.offset_mm, within(-1e4, 1e4),
             "of the body from the middle of the grid");
}

// Commands run while the command line is parsed, and throw UserError.
int run(int argc, char** argv) {
    CLI::App app("Writes phantoms of known shape as CT volumes.", "make_phantom");
    const auto add = [&](const char* name, const char* about, auto make, auto& arguments) -> CLI::App& {
        return addPhantom(app, name, about, make, arguments);
    };
    ToothArguments tooth;
    BlockArguments block;
    BodyArguments body;
    AnatomicArguments anatomic;
    addTooth(
        add("tooth", "molar-like tooth as a DICOM CT series, 256x256x161, 0.125 mm, HU", makeTooth, tooth),
        tooth);
    addBlock(add("block", "block of layers of any density as NRRD, HU; top face at z = 0", makeBlock, block),
             block);
    addBody(add("body", "analytic body as NRRD; the exact surfaces are in docs/reference/phantoms.md",
                makeBody, body),
            body);
    addAnatomicPhantoms(app, anatomic);
    app.require_subcommand(1);
    parseCommandLine(app, argc, argv, "make_phantom");
    return 0;
}

}  // namespace
}  // namespace bonemill

int main(int argc, char** argv) {
    return bonemill::runProgram([&] { return bonemill::run(argc, argv); });
}
