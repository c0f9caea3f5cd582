#include "tests/bench/bench_output.h"

#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fstream>

#include "common/base/user_error.h"
#include "common/rt/clock.h"
#include "haptic_server/recording/statistics/bone_files.h"

namespace bonemill::bench {
namespace {

size_t statusBytes(const char* field) {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.rfind(field, 0) == 0) return size_t(std::stoull(line.substr(line.find(':') + 1))) * 1024;
    return 0;
}

}  // namespace

nlohmann::json microseconds(const LatencyHistogram& durations) {
    const auto us = [&](double percent) { return microsecondsOfNs(double(durations.percentileNs(percent))); };
    return {{"mean", microsecondsOfNs(durations.meanNs())},
            {"p50", us(50)},
            {"p99", us(99)},
            {"p999", us(99.9)},
            {"max", microsecondsOfNs(double(durations.maxNs()))}};
}

void Table::add(std::vector<std::string> cells, const LatencyHistogram& durations) {
    const nlohmann::json us = microseconds(durations);
    for (const char* key : {"mean", "p50", "p99", "p999", "max"})
        cells.push_back(number(us[key].get<double>()));
    add(std::move(cells));
}

void Table::print() const {
    std::vector<size_t> width(rows_[0].size());
    for (const auto& row : rows_)
        for (size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
    for (const auto& row : rows_) {
        for (size_t c = 0; c < row.size(); ++c)
            std::printf(c == 0 ? "%-*s" : "  %*s", int(width[c]), row[c].c_str());
        std::printf("\n");
    }
}

std::string number(double value, int digits) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    return text;
}

nlohmann::json medianOf(const std::vector<nlohmann::json>& runs) {
    nlohmann::json median = runs.front();
    for (auto& [key, value] : median.items()) {
        std::vector<nlohmann::json> values;
        for (const nlohmann::json& run : runs) values.push_back(run.at(key));
        if (value.is_object()) {
            value = medianOf(values);
        } else if (value.is_number()) {
            std::sort(values.begin(), values.end());
            value = values[values.size() / 2];
        }
    }
    return median;
}

size_t residentBytes() {
    return statusBytes("VmRSS");
}
size_t peakResidentBytes() {
    return statusBytes("VmHWM");
}
size_t peakResidentBytesOfChildren() {
    rusage usage{};
    getrusage(RUSAGE_CHILDREN, &usage);
    return size_t(usage.ru_maxrss) * 1024;
}

void addJsonOption(CLI::App& command, std::string& path) {
    command.add_option("--json", path, "write the figures to FILE, or - for stdout")
        ->each([](const std::string& file) {
            if (file != "-") requireWritable(file);
        });
}

void writeJson(const std::string& path, const nlohmann::json& json) {
    if (path.empty()) return;
    if (path == "-") {
        std::printf("%s\n", json.dump(2).c_str());
        return;
    }
    std::ofstream file(path);
    file << json.dump(2) << '\n';
    file.close();
    if (!file) throw UserError(path + ": cannot be written");
}

}  // namespace bonemill::bench
