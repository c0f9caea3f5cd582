#include "haptic_server/apps/haptic_server/lab_commands.h"

#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <string>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

[[noreturn]] void becomeLab(const std::string& command, char** argv) {
    std::error_code error;
    const std::filesystem::path lab =
        std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "bonemill_lab";
    std::cerr << "haptic_server: " << command << " is a command of bonemill_lab, which does it now"
              << std::endl;
    execv(lab.c_str(), argv);
    throw UserError(lab.string() + ": cannot be run; it must lie beside haptic_server for " + command +
                    " (builds with BONEMILL_WITH_SCANS=OFF have none)");
}

}  // namespace

void addLabCommands(CLI::App& app, char** argv) {
    const auto add = [&](const std::string& name, const std::string& about) {
        app.add_subcommand(name, about)->preparse_callback([name, argv](size_t) { becomeLab(name, argv); });
    };
    add("accuracy-report",
        "measure errors and tick times of the accuracy settings in a scene, on this machine");
    add("replay", "show a recorded session again, as a live one (docs/teach/replay.md)");
    add("make-case", "make a training case of a scan (docs/teach/cases.md)");
    add("list-series", "print which DICOM series a folder holds, and which is the best for bone");
    add("session", "what can be done with what sessions have left");
}

}  // namespace bonemill
