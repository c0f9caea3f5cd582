// Every sub-command of haptic_bench prints this: a table for people, and on request the same as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/rt/latency_histogram.h"

namespace CLI {
class App;
}

namespace bonemill::bench {

// Returns {mean, p50, p99, p999, max}, µs.
nlohmann::json microseconds(const LatencyHistogram& durations);

class Table {
  public:
    explicit Table(std::vector<std::string> columns) : rows_{std::move(columns)} {}
    void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
    // The row has "mean", "p50", "p99", "p99.9" and "max" of the durations after these cells.
    void add(std::vector<std::string> cells, const LatencyHistogram& durations);
    void print() const;

  private:
    std::vector<std::vector<std::string>> rows_;
};

std::string number(double value, int digits = 4);

// Takes of every number in these alike objects the median, of anything else the first's.
nlohmann::json medianOf(const std::vector<nlohmann::json>& runs);

// They give the resident memory of this process in bytes: now, and the most there ever was.
size_t residentBytes();
size_t peakResidentBytes();
size_t peakResidentBytesOfChildren();  // of the largest that has ended

// This is for --json. A file that cannot be written is a UserError when the command line is read, before
// anything is measured.
void addJsonOption(CLI::App& command, std::string& path);

// "" writes nothing, "-" goes to stdout. Throws UserError when the file cannot be written.
void writeJson(const std::string& path, const nlohmann::json& json);

}  // namespace bonemill::bench
