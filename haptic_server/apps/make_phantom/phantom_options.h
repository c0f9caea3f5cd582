// Helps the commands of make_phantom: options that several have, and the writing of volumes. Start-up only.
#pragma once

#include <CLI/CLI.hpp>
#include <iostream>
#include <span>
#include <string>

#include "common/cli/command_line.h"
#include "haptic_server/scans/nrrd/nrrd_writer.h"

namespace bonemill {

// make(arguments) runs while the command line is parsed, and throws UserError.
template <class Make, class Arguments>
CLI::App& addPhantom(CLI::App& app, const char* name, const char* about, Make make, Arguments& arguments) {
    CLI::App* const command = app.add_subcommand(name, about);
    command->callback([make, &arguments] { make(arguments); });
    return *command;
}

inline void addNumber(CLI::App& command, const char* name, double& value, double low, double high,
                      const char* help) {
    command.add_option(name, value, help)->check(within(low, high))->capture_default_str();
}

inline void addSeed(CLI::App& command, uint64_t& seed, const char* help) {
    command.add_option("--seed", seed, help)->check(within(0, 1e15))->capture_default_str();
}

template <class T>
void write(const std::string& file, const VolumeGeometry& geometry, std::span<const T> values) {
    NrrdStream<T> stream(file, geometry);
    stream.append(values);
    stream.close();
    std::cout << "wrote " << file << "\n";
}

}  // namespace bonemill
