#include "haptic_server/recording/align/align_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/files/require_file.h"
#include "common/files/whole_file.h"
#include "common/text/foreign_text.h"

namespace bonemill {
namespace {

constexpr const char* kBeaconClock = "beacon_session_ns";
constexpr const char* kBeaconRecording = "beacon_recording";

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kAround = " \t\r\"";
    const size_t first = text.find_first_not_of(kAround);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kAround) - first + 1);
}

// A comma in quotes parts nothing. Views of the line.
std::vector<std::string_view> fieldsOf(std::string_view line) {
    std::vector<std::string_view> fields;
    bool is_quoted = false;
    size_t begin = 0;
    for (size_t n = 0; n <= line.size(); ++n) {
        if (n < line.size() && line[n] == '"') is_quoted = !is_quoted;
        if (n < line.size() && (line[n] != ',' || is_quoted)) continue;
        fields.push_back(trimmed(line.substr(begin, n - begin)));
        begin = n + 1;
    }
    return fields;
}

std::optional<double> numberOf(std::string_view text) {
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number))
        return std::nullopt;
    return number;
}

// The table of another program, read line by line.
class ForeignTable {
  public:
    ForeignTable(const std::string& path, const std::string& clock) : path_(path) {
        requireFile(path);
        file_.open(path, std::ios::binary);
        if (!std::getline(file_, header_)) throw UserError(path + ": cannot be read, or is empty");
        if (header_.starts_with("\xef\xbb\xbf")) header_.erase(0, 3);  // as spreadsheets begin a file
        if (header_.ends_with('\r')) header_.pop_back();
        const std::vector<std::string_view> names = fieldsOf(header_);
        clock_ = clock.empty() ? 0 : require(names, clock);
        beacon_ = require(names, kBeaconClock);
        const auto recording = std::ranges::find(names, kBeaconRecording);
        if (recording != names.end()) recording_ = size_t(recording - names.begin());
    }

    struct Row {
        std::string_view line;
        double time;  // of its own clock
        std::optional<double> beacon_ns;
        std::string_view recording;
    };
    // From here to the file's end, each in turn. Throws UserError for a row without a time.
    void forEachRow(const std::function<void(const Row&)>& visit) {
        size_t number = 1;
        for (std::string line; std::getline(file_, line);) {
            ++number;
            if (line.ends_with('\r')) line.pop_back();
            if (trimmed(line).empty()) continue;
            const std::vector<std::string_view> fields = fieldsOf(line);
            const auto at = [&](size_t column) {
                return column < fields.size() ? fields[column] : std::string_view();
            };
            const std::optional<double> time = numberOf(at(clock_));
            if (!time)
                throw UserError(path_ + ":" + std::to_string(number) + ": '" +
                                printableLine(std::string(at(clock_))) + "' is no time");
            visit({line, *time, numberOf(at(beacon_)), recording_ ? at(*recording_) : std::string_view()});
        }
        if (!file_.eof()) throw UserError(path_ + ": cannot be read to its end");
    }
    const std::string& header() const { return header_; }

  private:
    size_t require(const std::vector<std::string_view>& names, const std::string& name) const {
        const auto found = std::ranges::find(names, name);
        if (found == names.end())
            throw UserError(path_ + ": has no column '" + printableLine(name) +
                            "'; its first line names the columns (docs/reference/beacon.md)");
        return size_t(found - names.begin());
    }

    std::string path_, header_;
    std::ifstream file_;
    size_t clock_ = 0, beacon_ = 0;
    std::optional<size_t> recording_;
};

// Fills in what does not count, too.
std::vector<ClockPair> pairsOf(ForeignTable& table, const std::string& journal_id, Alignment& out) {
    std::vector<ClockPair> pairs;
    table.forEachRow([&](const ForeignTable::Row& row) {
        if (!row.beacon_ns) return;
        if (!row.recording.empty() && row.recording != journal_id)
            ++out.other_beacons;
        else
            pairs.push_back({row.time, *row.beacon_ns / double(kNsPerSecond)});
    });
    return pairs;
}

}  // namespace

std::string alignedPathOf(const std::string& csv) {
    if (csv.empty()) return "";
    std::filesystem::path path(csv);
    return path.replace_filename(path.stem().string() + "_aligned" + path.extension().string()).string();
}

std::string Alignment::text() const {
    char out[256];
    std::snprintf(
        out, sizeof out,
        "%zu rows by %zu beacons: 1 of its clock is %.9f s (least squares); beacons lie %.3f ms beside "
        "that (rms), %.3f ms at most%s",
        rows, fit.pairs, fit.rate, fit.rms_s * kPerMilli, fit.max_s * kPerMilli,
        fit.pairs < 2 ? "; one beacon gives the offset alone" : "");
    return out + (other_beacons == 0 ? std::string()
                                     : "; " + std::to_string(other_beacons) +
                                           " beacons of another recording were passed over");
}

Alignment alignFile(const std::string& csv, const std::string& out, const std::string& clock,
                    const std::string& journal_id) {
    Alignment alignment;
    ForeignTable first(csv, clock);
    const std::vector<ClockPair> pairs = pairsOf(first, journal_id, alignment);
    if (pairs.empty())
        throw UserError(csv + ": no row has a beacon of this recording, which is " +
                        printableLine(journal_id));
    alignment.fit = fitClock(pairs);
    WholeFile file(out);
    std::ofstream written(file.part(), std::ios::binary);
    ForeignTable again(csv, clock);
    written << "session_s," << again.header() << '\n';
    again.forEachRow([&](const ForeignTable::Row& row) {
        char time[32];
        std::snprintf(time, sizeof time, "%.9f,", alignment.fit.sessionOf(row.time));
        written << time << row.line << '\n';
        ++alignment.rows;
    });
    written.close();
    if (!written) throw UserError(out + ": cannot be written to its end (disk full?)");
    file.finish();
    return alignment;
}

}  // namespace bonemill
