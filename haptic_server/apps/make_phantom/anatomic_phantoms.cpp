#include "haptic_server/apps/make_phantom/anatomic_phantoms.h"

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/files/require_apart.h"
#include "haptic_server/apps/make_phantom/phantom_options.h"
#include "haptic_server/cases/phantom/skull_labels.h"
#include "haptic_server/cases/phantom/temporal_bone_phantom.h"
#include "haptic_server/cases/phantom/third_molar_phantom.h"
#include "haptic_server/cases/phantom/vertebra_phantom.h"
#include "haptic_server/scans/import/import_volume.h"

namespace bonemill {
namespace {

// HU are whole numbers.
void writeScan(const std::string& file, const std::string& labels_file, const RawVolume& ct,
               const std::vector<uint8_t>& labels) {
    const std::vector<int16_t> hu = ct.values.visit(
        [](const auto& samples) { return std::vector<int16_t>(samples.begin(), samples.end()); });
    write<int16_t>(file, ct.geometry, hu);
    if (!labels_file.empty()) write<uint8_t>(labels_file, ct.geometry, labels);
}

VertebraKind kindOf(const VertebraArguments& arguments) {
    using enum VertebraKind::Pedicles;
    VertebraKind kind;
    kind.seed = arguments.seed;
    kind.is_porous = arguments.bone == "porous";
    if (arguments.pedicles != "wide") kind.pedicles = arguments.pedicles == "middle" ? kMiddle : kNarrow;
    return kind;
}

TemporalBoneKind kindOf(const TemporalArguments& arguments) {
    using enum TemporalBoneKind::Pneumatisation;
    TemporalBoneKind kind;
    kind.seed = arguments.seed;
    kind.is_right = arguments.side == "right";
    kind.has_high_jugular = arguments.jugular == "high";
    kind.has_low_dura = arguments.dura == "low";
    if (arguments.pneumatisation != "well")
        kind.pneumatisation = arguments.pneumatisation == "poor" ? kPoor : kSclerotic;
    return kind;
}

ThirdMolarKind kindOf(const MolarArguments& arguments) {
    using enum ThirdMolarKind::Impaction;
    using enum ThirdMolarKind::Nerve;
    ThirdMolarKind kind;
    kind.seed = arguments.seed;
    kind.is_right = arguments.side == "right";
    if (arguments.impaction != "shallow") kind.impaction = arguments.impaction == "middle" ? kMiddle : kDeep;
    if (arguments.nerve != "far") kind.nerve = arguments.nerve == "near" ? kNear : kTouching;
    return kind;
}

template <class Phantom, class Arguments>
void makeScan(const Arguments& arguments) {
    requireApart({{"--out", arguments.file}, {"--labels", arguments.labels}}, {});
    const Phantom phantom(kindOf(arguments));
    const auto scan = phantom.scan(phantom.grid(arguments.voxel_mm * kMillimetre));
    writeScan(arguments.file, arguments.labels, scan.ct, scan.labels);
}

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

void addChoice(CLI::App& command, const char* name, std::string& value,
               const std::vector<std::string>& choices, const char* help) {
    command.add_option(name, value, help)->check(CLI::IsMember(choices))->capture_default_str();
}

void addVertebra(CLI::App& vertebra, VertebraArguments& arguments) {
    vertebra.add_option("--out", arguments.file, "NRRD file to write")->required();
    vertebra.add_option("--labels", arguments.labels, "NRRD file to write the tissues to, on the same grid");
    addNumber(vertebra, "--voxel-mm", arguments.voxel_mm, 0.2, 2, "edge of a voxel");
    addSeed(vertebra, arguments.seed, "another seed is another vertebra; 0 has the sizes of the tables");
    addChoice(vertebra, "--pedicles", arguments.pedicles, {"wide", "middle", "narrow"}, "10, 7.5 or 6 mm");
    addChoice(vertebra, "--bone", arguments.bone, {"firm", "porous"},
              "thickness of the shell, density of the core");
}

void addTemporalBone(CLI::App& bone, TemporalArguments& arguments) {
    bone.add_option("--out", arguments.file, "NRRD file to write")->required();
    bone.add_option("--labels", arguments.labels,
                    "NRRD file to write: 1 sigmoid sinus, 2 facial nerve, 3 dura, 4 semicircular canals, 5 "
                    "ossicles, 0 none");
    addNumber(bone, "--voxel-mm", arguments.voxel_mm, 0.1, 2, "edge of a voxel");
    addSeed(bone, arguments.seed, "another seed is another bone");
    addChoice(bone, "--side", arguments.side, {"left", "right"}, "the mirror image of the other one");
    addChoice(bone, "--pneumatisation", arguments.pneumatisation, {"well", "poor", "sclerotic"},
              "how far air cells reach");
    addChoice(bone, "--jugular", arguments.jugular, {"normal", "high"}, "dome of the jugular bulb");
    addChoice(bone, "--dura", arguments.dura, {"normal", "low"}, "middle fossa over the mastoid");
}

void addThirdMolar(CLI::App& molar, MolarArguments& arguments) {
    molar.add_option("--out", arguments.file, "NRRD file to write")->required();
    molar.add_option("--labels", arguments.labels,
                     "NRRD file to write: 1 alveolar nerve, 2 enamel, 3 dentine, 4 pulp of the third molar, "
                     "5 second molar, 6 lingual plate, 0 none");
    addNumber(molar, "--voxel-mm", arguments.voxel_mm, 0.1, 2, "edge of a voxel");
    addSeed(molar, arguments.seed, "another seed is another jaw");
    addChoice(molar, "--side", arguments.side, {"left", "right"}, "the mirror image of the other one");
    addChoice(molar, "--impaction", arguments.impaction, {"shallow", "middle", "deep"},
              "how deep the crown lies below the bone's crest");
    addChoice(molar, "--nerve", arguments.nerve, {"far", "near", "touching"}, "from the roots");
}

void addSkullLabels(CLI::App& skull, SkullArguments& arguments) {
    skull.add_option("--volume", arguments.volume, "that scan, Cranium.inv3")->required();
    skull.add_option("--out", arguments.file, "NRRD file to write")->required();
}

}  // namespace

void addAnatomicPhantoms(CLI::App& app, AnatomicArguments& arguments) {
    addVertebra(addPhantom(app, "vertebra", "lumbar vertebra with nerves and vessels as NRRD, HU",
                           makeScan<Vertebra, VertebraArguments>, arguments.vertebra),
                arguments.vertebra);
    addTemporalBone(addPhantom(app, "temporal_bone", "mastoid with air cells and what lies in it as NRRD, HU",
                               makeScan<TemporalBone, TemporalArguments>, arguments.temporal_bone),
                    arguments.temporal_bone);
    addThirdMolar(
        addPhantom(app, "third_molar", "piece of lower jaw with an impacted third molar as NRRD, HU",
                   makeScan<ThirdMolar, MolarArguments>, arguments.third_molar),
        arguments.third_molar);
    addSkullLabels(addPhantom(app, "skull_labels", "structures to spare in the left mastoid of Cranium.inv3",
                              makeSkullLabels, arguments.skull),
                   arguments.skull);
}

}  // namespace bonemill
