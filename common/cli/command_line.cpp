#include "common/cli/command_line.h"

#include <iostream>

#include "common/base/user_error.h"
#include "common/cli/version.h"

namespace bonemill {

bool parseCommandLine(CLI::App& app, int argc, const char* const* argv, const std::string& program) {
    app.set_version_flag("--version", program + " " + versionText(), "Print the version and end");
    try {
        app.parse(argc, argv);
        return true;
    } catch (const CLI::CallForHelp&) {
        std::cout << app.help();
        return false;
    } catch (const CLI::CallForVersion&) {
        std::cout << app.version() << '\n';
        return false;
    } catch (const CLI::ParseError& error) {
        throw UserError(std::string(error.what()) + " (see " + program + " --help)");
    }
}

void addLogLevelOption(CLI::App& app, std::string& log_level) {
    app.add_option("--log-level", log_level, "trace, debug, info, warn, error or off")->capture_default_str();
}

void addRealtimeOptions(CLI::App& app, const std::string& loop, bool& is_strict, int& core) {
    constexpr int kMaxCores = 4096;
    app.add_flag("--strict-rt", is_strict, "Refuse to go on without real-time scheduling and locked memory");
    app.add_option("--rt-core", core, "Processor core for " + loop + " (-1: any)")
        ->check(CLI::Range(-1, kMaxCores - 1))
        ->capture_default_str();
}

void addParentOption(CLI::App& app, std::optional<int>& parent) {
    app.add_option("--end-with-parent", parent,
                   "Number of the process that has started it: ends when that one does");
}

}  // namespace bonemill
