// Writes phantoms: a tooth as a DICOM CT series, a vertebra and analytic bodies as NRRD. See docs/volumes.md.
#include <CLI/CLI.hpp>
#include <iostream>
#include <limits>
#include <numbers>

#include "common/config/user_error.h"
#include "haptic_server/volume/import/nrrd_stream.h"
#include "haptic_server/volume/import/phantom/analytic_body.h"
#include "haptic_server/volume/import/phantom/anatomy_commands.h"
#include "haptic_server/volume/import/phantom/dicom_series_writer.h"
#include "haptic_server/volume/import/phantom/number_range.h"
#include "haptic_server/volume/import/phantom/tooth_phantom.h"

namespace bonemill {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kMillimetre = 1e-3;

struct ToothArguments {
    std::string folder;
    ToothScan scan;
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

void makeTooth(const ToothArguments& arguments) {
    const std::string seed = "bonemill tooth, noise " + std::to_string(arguments.scan.noise_hu) +
                             " HU, seed " + std::to_string(arguments.scan.seed);
    const RawVolume tooth = scanTooth(toothGrid(), arguments.scan);
    writeCtSeries(arguments.folder, tooth, {"PHANTOM^TOOTH", "bonemill tooth phantom", seed});
    std::cout << "wrote " << tooth.geometry.dims.z() << " slices to " << arguments.folder << "\n";
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

// T as wide as the file's samples.
template <class T>
void writeBody(const BodyArguments& arguments) {
    const VolumeGeometry grid =
        centredGrid(Eigen::Vector3i(arguments.dims.data()), arguments.voxel_mm * kMillimetre);
    const AnalyticBody body = bodyOf(arguments);
    constexpr double kFull = std::numeric_limits<T>::max();
    NrrdStream<T> file(arguments.file, grid, NrrdEncoding::kGzip);
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

void addTooth(CLI::App& app, ToothArguments& arguments) {
    CLI::App* tooth =
        app.add_subcommand("tooth", "molar-like tooth as a DICOM CT series, 256x256x161, 0.125 mm, HU");
    tooth->add_option("--out", arguments.folder, "folder to write to")->required();
    tooth->add_option("--noise-hu", arguments.scan.noise_hu, "standard deviation of the noise")
        ->check(within(0, 500))
        ->capture_default_str();
    tooth->add_option("--seed", arguments.scan.seed, "seed of the noise")->capture_default_str();
}

void addBody(CLI::App& app, BodyArguments& arguments) {
    CLI::App* body =
        app.add_subcommand("body", "analytic body as NRRD; the exact surfaces are in docs/volumes.md");
    body->add_option("--kind", arguments.kind, "slab, sphere, hole, wedge or thin-wall")
        ->required()
        ->check(CLI::IsMember({"slab", "sphere", "hole", "wedge", "thin-wall"}));
    body->add_option("--out", arguments.file, "NRRD file to write")->required();
    const auto number = [&](const char* name, double& value, double low, double high, const char* help) {
        body->add_option(name, value, help)->check(within(low, high))->capture_default_str();
    };
    number("--voxel-mm", arguments.voxel_mm, 1e-3, 100, "edge of a voxel");
    number("--radius-mm", arguments.radius_mm, 1e-3, 1e4, "sphere and hole");
    number("--thickness-mm", arguments.thickness_mm, 1e-3, 1e4, "slab, plate with the hole and thin wall");
    number("--angle-deg", arguments.angle_deg, 1, 179, "full opening angle of the wedge");
    body->add_option("--bits", arguments.bits, "8 or 16")
        ->check(CLI::IsMember({8, 16}))
        ->capture_default_str();
    body->add_option("--dims", arguments.dims, "voxels per axis")
        ->expected(3)
        ->check(CLI::Range(2, 1024))
        ->capture_default_str();
    body->add_option("--rotate-deg", arguments.rotate_deg, "about x, then y, then z of the world")
        ->expected(3)
        ->check(within(-360, 360))
        ->capture_default_str();
    body->add_option("--offset-mm", arguments.offset_mm, "of the body from the middle of the grid")
        ->expected(3)
        ->check(within(-1e4, 1e4))
        ->capture_default_str();
}

int run(int argc, char** argv) {
    CLI::App app("Writes phantoms of known shape as CT volumes.", "make_phantom");
    ToothArguments tooth;
    BodyArguments body;
    addTooth(app, tooth);
    addBody(app, body);
    addAnatomyCommands(app);
    app.require_subcommand(1);
    try {
        app.parse(argc, argv);
        if (app.got_subcommand("tooth")) makeTooth(tooth);
        if (app.got_subcommand("body")) makeBody(body);
    } catch (const CLI::Success& success) {
        return app.exit(success);
    } catch (const std::exception& error) {  // CLI::ParseError, UserError, std::bad_alloc
        std::cerr << "error: " << error.what() << "\n";
        return kUserErrorExitCode;
    }
    return 0;
}

}  // namespace
}  // namespace bonemill

int main(int argc, char** argv) {
    return bonemill::run(argc, argv);
}
