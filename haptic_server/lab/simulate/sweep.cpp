#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/config/scene_file.h"
#include "haptic_server/lab/simulate/simulate.h"

namespace bonemill {
namespace {

constexpr size_t kMostValues = 256;

void requireNoFiles(const SimulateOptions& options) {
    const SavePaths& save = options.save;
    for (const std::string& path :
         {options.trace, options.deviation, options.assess, save.volume, save.mesh, save.difference})
        if (!path.empty())
            throw UserError("--sweep: each run would write over " + path +
                            "; run simulate with --set for files");
}

std::string rowOf(const std::string& value, const nlohmann::json& run) {
    const auto number = [&run](const char* key) { return run.at(key).get<double>(); };
    char text[256];
    std::snprintf(text, sizeof text, "%-14s %9.3f %9.4f %9.3f %8.1f %8.1f  %s", value.c_str(),
                  number("max_force_n"), kPerMillimetre * number("max_penetration_m"), number("removed_mm3"),
                  run.at("tick_us").at("p50").get<double>(), run.at("tick_us").at("p99").get<double>(),
                  run.at("state_hash").get<std::string>().c_str());
    std::string row = text;
    if (run.contains("assessment") && run["assessment"].contains("total")) {
        std::snprintf(text, sizeof text, "  %5.1f",
                      100 * run["assessment"]["total"].at("score").get<double>());
        row += text;
    }
    const auto faults = run.at("fault_names").get<std::string>();
    return row + (faults.empty() ? "" : "  " + faults);
}

}  // namespace

Sweep readSweep(const std::string& text) {
    const size_t equals = text.find('=');
    Sweep sweep{text.substr(0, equals), {}};
    std::istringstream values(equals == std::string::npos ? "" : text.substr(equals + 1));
    for (std::string value; std::getline(values, value, ',');) sweep.values.push_back(value);
    if (sweep.field.empty() || sweep.values.empty() || sweep.values.size() > kMostValues)
        throw UserError("--sweep " + text +
                        ": give PATH=VALUE,VALUE,..., as coupling.max_speed_mm_per_s=40,80,160");
    return sweep;
}

std::string simulateSweep(const SimulateOptions& options, const Sweep& sweep) {
    requireNoFiles(options);
    const auto settingsWith = [&](const std::string& value) {
        std::vector<std::string> settings = options.settings;
        settings.push_back(sweep.field + "=" + value);
        return settings;
    };
    for (const std::string& value : sweep.values) loadScene(options.scene, settingsWith(value));
    std::string table =
        sweep.field + "\nvalue            force N  depth mm  gone mm3   p50 us   p99 us  state hash\n";
    nlohmann::json runs = nlohmann::json::array();
    for (const std::string& value : sweep.values) {
        SimulateOptions one = options;
        one.settings = settingsWith(value);
        nlohmann::json run = nlohmann::json::parse(simulate(one).json);
        table += rowOf(value, run) + "\n";
        run["value"] = value;
        runs.push_back(std::move(run));
    }
    return table + runs.dump() + "\n";
}

}  // namespace bonemill
