// The commands of make_phantom that make parts of a body: vertebra, temporal bone, third molar, and what lies
// in the CT head. Start-up only.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

namespace bonemill {

struct VertebraArguments {
    std::string file, labels;
    double voxel_mm = 0.4;
    uint64_t seed = 0;
    std::string pedicles = "wide", bone = "firm";
};

struct TemporalArguments {
    std::string file, labels;
    double voxel_mm = 0.15;
    uint64_t seed = 1;
    std::string side = "left", pneumatisation = "well", jugular = "normal", dura = "normal";
};

struct MolarArguments {
    std::string file, labels;
    double voxel_mm = 0.2;
    uint64_t seed = 1;
    std::string side = "left", impaction = "shallow", nerve = "far";
};

struct SkullArguments {
    std::string volume, file;
};

struct AnatomicArguments {
    VertebraArguments vertebra;
    TemporalArguments temporal_bone;
    MolarArguments third_molar;
    SkullArguments skull;
};

// The arguments must live until the command line is parsed: then the commands run, and throw UserError.
void addAnatomicPhantoms(CLI::App& app, AnatomicArguments& arguments);

}  // namespace bonemill
