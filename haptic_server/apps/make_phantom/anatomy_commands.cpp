#include "haptic_server/apps/make_phantom/anatomy_commands.h"

#include <iostream>
#include <memory>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/cli/command_line.h"
#include "common/files/require_apart.h"
#include "haptic_server/cases/phantom/skull_labels.h"
#include "haptic_server/cases/phantom/vertebra_phantom.h"
#include "haptic_server/scans/import/import_volume.h"
#include "haptic_server/scans/nrrd/nrrd_stream.h"

namespace bonemill {
namespace {

template <class T>
void write(const std::string& file, const VolumeGeometry& geometry, std::span<const T> values) {
    NrrdStream<T> stream(file, geometry, NrrdEncoding::kGzip);
    stream.append(values);
    stream.close();
    std::cout << "wrote " << file << "\n";
}

struct VertebraArguments {
    std::string file, labels;
    double voxel_mm = 0.4;
};

void makeVertebra(const VertebraArguments& arguments) {
    requireApart({{"--out", arguments.file}, {"--labels", arguments.labels}}, {});
    const VertebraScan scan = scanVertebra(vertebraGrid(arguments.voxel_mm * kMillimetre));
    const std::vector<int16_t> hu = scan.ct.values.visit(
        [](const auto& samples) { return std::vector<int16_t>(samples.begin(), samples.end()); });
    write<int16_t>(arguments.file, scan.ct.geometry, hu);
    if (!arguments.labels.empty()) write<uint8_t>(arguments.labels, scan.ct.geometry, scan.labels);
}

struct SkullArguments {
    std::string volume, file;
};

void makeSkullLabels(const SkullArguments& arguments) {
    requireApart({{"--out", arguments.file}}, {{"--volume", arguments.volume}});
    const VolumeGeometry geometry = importVolume(arguments.volume).geometry;
    if (geometry.dims != kCraniumDims)
        throw UserError(
            arguments.volume +
            ": is not the CT head that these structures were placed in; give Cranium.inv3 of Debian's "
            "invesalius-examples");
    write<uint8_t>(arguments.file, geometry, skullLabels(geometry));
}

}  // namespace

void addAnatomyCommands(CLI::App& app) {
    const auto vertebra = std::make_shared<VertebraArguments>();
    CLI::App* command = app.add_subcommand("vertebra", "lumbar vertebra with nerves and vessels as NRRD, HU");
    command->add_option("--out", vertebra->file, "NRRD file to write")->required();
    command->add_option("--labels", vertebra->labels, "NRRD file to write the tissues to, on the same grid");
    command->add_option("--voxel-mm", vertebra->voxel_mm, "edge of a voxel")
        ->check(within(0.2, 2))
        ->capture_default_str();
    command->callback([vertebra] { makeVertebra(*vertebra); });

    const auto skull = std::make_shared<SkullArguments>();
    command = app.add_subcommand("skull_labels", "structures to spare in the left mastoid of Cranium.inv3");
    command->add_option("--volume", skull->volume, "that scan, Cranium.inv3")->required();
    command->add_option("--out", skull->file, "NRRD file to write")->required();
    command->callback([skull] { makeSkullLabels(*skull); });
}

}  // namespace bonemill
