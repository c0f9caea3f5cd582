#include "common/cli/command_line.h"

#include <iostream>
#include <memory>
#include <string>
#include <utility>

#include "common/base/user_error.h"
#include "common/cli/version.h"

namespace bonemill {
namespace {

// What does not go together is said when someone tries: a list of it beside each option is read by nobody.
class HelpFormatter : public CLI::Formatter {
  public:
    // A flag that says no has that in its name.
    std::string make_option_name(const CLI::Option* option, bool is_positional) const override {
        const std::string name = CLI::Formatter::make_option_name(option, is_positional);
        return name.substr(0, name.find('{'));
    }
    std::string make_option_opts(const CLI::Option* option) const override {
        std::string words;
        if (option->get_type_size() != 0) {
            words = " " + takes(option->get_type_name());
            if (!option->get_default_str().empty()) words += "=" + option->get_default_str();
            if (option->get_expected_min() > 1) words += " x " + std::to_string(option->get_expected());
            if (option->get_required()) words += " REQUIRED";
        }
        const char* separator = " with ";
        for (const CLI::Option* needed : option->get_needs())
            words += std::exchange(separator, ", ") + needed->get_name();
        return words == " " ? "" : words;
    }

  private:
    // CLI11 names the type twice: "UINT:UINT in [1 - 9]", "TEXT:{a,b}", "WIDTH:NUMBER".
    static std::string takes(const std::string& type) {
        const size_t colon = type.find(':');
        if (colon == std::string::npos) return type;
        const std::string name = type.substr(0, colon), check = type.substr(colon + 1);
        if (check.starts_with('{')) return check;
        const size_t range = check.find(" in [");
        return range == std::string::npos ? name : name + check.substr(range);
    }
};

void setFormatter(CLI::App& app, const std::shared_ptr<HelpFormatter>& formatter) {
    app.formatter(formatter);
    for (CLI::App* verb : app.get_subcommands({})) setFormatter(*verb, formatter);
}

}  // namespace

bool parseCommandLine(CLI::App& app, int argc, const char* const* argv, const std::string& program) {
    app.set_version_flag("--version", program + " " + versionText(), "Print the version and end");
    setFormatter(app, std::make_shared<HelpFormatter>());
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
