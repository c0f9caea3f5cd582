#include "haptic_server/scene/trajectory/trajectory_reader.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <istream>
#include <limits>

#include "common/base/user_error.h"
#include "common/files/require_file.h"
#include "common/text/text_encoding.h"

namespace bonemill {
namespace {

// Calls visit(bit, whether it is set) for the bits of "input_flags".
template <class Input, class Visit>
void forEachFlag(Input& input, Visit&& visit) {
    auto& decisions = input.decisions;
    visit(uint64_t(1), input.is_repeated);
    visit(uint64_t(2), input.is_stale);
    visit(uint64_t(4), decisions.is_milling_paused);
    visit(uint64_t(8), decisions.is_write_refused);
    visit(uint64_t(16), decisions.is_milling_put_off);
    visit(uint64_t(32), decisions.is_heat_put_off);
}
// The bits above are TickDecisions::milling_thrift.
constexpr int kThriftShift = 6;
constexpr uint64_t kAllFlags = uint64_t(kMostThrift) << kThriftShift | ((uint64_t(1) << kThriftShift) - 1);
constexpr uint64_t kMaxPeriods = 10'000;
constexpr size_t kDigitsPerByte = 2;

enum Column : size_t { kTime, kPx, kPy, kPz, kQw, kQx, kQy, kQz, kButtons, kColumnCount };
constexpr std::array<std::string_view, kColumnCount> kColumnNames = {"t_s", "px_m", "py_m", "pz_m",   "qw",
                                                                     "qx",  "qy",   "qz",   "buttons"};
constexpr double kNormTolerance = 1e-3;

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kBlank = " \t\r";
    const size_t first = text.find_first_not_of(kBlank);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

void split(std::string_view line, std::vector<std::string_view>& cells) {
    cells.clear();
    for (size_t start = 0; start <= line.size();) {
        const size_t end = std::min(line.find(',', start), line.size());
        cells.push_back(trimmed(line.substr(start, end - start)));
        start = end + 1;
    }
}

// Makes one pass over the file and knows where it is for its messages.
class Reader {
  public:
    Reader(std::istream& input, const std::string& name) : input_(input), name_(name) {}

    std::vector<TrajectoryRow> read() {
        readHeader();
        std::vector<TrajectoryRow> rows;
        while (nextLine()) {
            rows.push_back(parseRow());
            if (rows.size() > 1 && !(rows.back().t_s > rows[rows.size() - 2].t_s)) {
                fail("t_s does not increase: each row needs a later time than the one above");
            }
        }
        if (input_.bad()) fail("cannot be read further");
        if (rows.empty()) fail("has no rows below the header: add one row per tick");
        return rows;
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw UserError("trajectory " + name_ + ":" + std::to_string(line_number_) + ": " + what);
    }

    // Goes to the next line that is not blank.
    bool nextLine() {
        while (std::getline(input_, line_)) {
            ++line_number_;
            if (!trimmed(line_).empty()) return true;
        }
        return false;
    }

    void readHeader() {
        if (!nextLine()) fail("is empty: it needs the header t_s,px_m,py_m,pz_m,qw,qx,qy,qz,buttons");
        requireUtf8(line_, "trajectory " + name_);
        split(line_, cells_);
        header_size_ = cells_.size();
        for (size_t column = 0; column < kColumnCount; ++column) {
            const auto found = std::find(cells_.begin(), cells_.end(), kColumnNames[column]);
            if (found == cells_.end()) {
                fail("column '" + std::string(kColumnNames[column]) +
                     "' is missing; the header must name t_s,px_m,py_m,pz_m,qw,qx,qy,qz,buttons");
            }
            position_[column] = size_t(found - cells_.begin());
        }
        findRecordedColumns();
    }

    void findRecordedColumns() {
        std::vector<std::string_view> names(kRecordedNumbers.begin(), kRecordedNumbers.end());
        names.insert(names.end(), {kStaleFactorColumn, kDeviceColumn});
        for (const std::string_view name : names) {
            const auto found = std::find(cells_.begin(), cells_.end(), name);
            if (found == cells_.end()) return recorded_.clear();
            recorded_.push_back(size_t(found - cells_.begin()));
        }
    }

    // The recorded columns come in the order of their names.
    std::shared_ptr<const TrajectoryRow::Recorded> recordedRow() const {
        auto row = std::make_shared<TrajectoryRow::Recorded>();
        std::array<uint64_t, kRecordedNumbers.size()> numbers{};
        for (size_t n = 0; n < numbers.size(); ++n)
            if (!parseCell(cells_[recorded_[n]], numbers[n]))
                fail(std::string(kRecordedNumbers[n]) + " is no whole number");
        if (!takeNumbers(numbers, row->input, row->device)) fail("the recorded numbers are out of range");
        double& factor = row->input.stale_factor;
        if (!parseCell(cells_[recorded_[kRecordedNumbers.size()]], factor) || !(factor >= 0 && factor <= 1))
            fail("stale_factor is not 0 to 1");
        const std::string_view device = cells_[recorded_.back()];
        row->input.has_other_device = !device.empty();
        if (!device.empty() && !takeDevice(device, row->input.other_device)) fail("device is no device");
        return row;
    }

    TrajectoryRow parseRow() {
        split(line_, cells_);
        if (cells_.size() != header_size_) {
            fail("has " + std::to_string(cells_.size()) + " cells, the header has " +
                 std::to_string(header_size_));
        }
        TrajectoryRow row;
        row.t_s = number(kTime);
        row.buttons = buttonMask();
        if (!recorded_.empty()) {
            row.recorded = recordedRow();
            row.X_WT.position = {anyNumber(kPx), anyNumber(kPy), anyNumber(kPz)};
            row.X_WT.rotation = {anyNumber(kQw), anyNumber(kQx), anyNumber(kQy), anyNumber(kQz)};
            return row;
        }
        row.X_WT.position = {number(kPx), number(kPy), number(kPz)};
        row.X_WT.rotation = rotation();
        return row;
    }

    Eigen::Quaterniond rotation() const {
        const Eigen::Quaterniond q(number(kQw), number(kQx), number(kQy), number(kQz));
        if (!(std::abs(q.norm() - 1.0) <= kNormTolerance)) {
            fail("quaternion qw,qx,qy,qz has norm " + std::to_string(q.norm()) +
                 ", it must be 1 within 0.001");
        }
        return q;
    }

    template <class Number>
    bool parse(Column column, Number& value) const {
        return parseCell(cells_[position_[column]], value);
    }

    template <class Number>
    static bool parseCell(std::string_view cell, Number& value) {
        const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
        return error == std::errc() && end == cell.data() + cell.size();
    }

    // What a device said may be no finite number: the tick refuses it once more.
    double anyNumber(Column column) const {
        double value = 0.0;
        if (!parse(column, value)) failAt(column, "a number");
        return value;
    }

    [[noreturn]] void failAt(Column column, const char* expected) const {
        fail(std::string(kColumnNames[column]) + " is '" + std::string(cells_[position_[column]]) +
             "', not " + expected);
    }

    double number(Column column) const {
        double value = 0.0;
        if (!parse(column, value) || !std::isfinite(value)) failAt(column, "a finite number");
        return value;
    }

    uint32_t buttonMask() const {
        uint32_t mask = 0;
        if (!parse(kButtons, mask)) failAt(kButtons, "a bit mask (0 none, 1 remove, 2 add)");
        return mask;
    }

    std::istream& input_;
    std::string name_;
    std::string line_;
    size_t line_number_ = 0;
    size_t header_size_ = 0;
    std::vector<std::string_view> cells_;
    std::array<size_t, kColumnCount> position_{};
    std::vector<size_t> recorded_;  // positions; empty: there are none
};

}  // namespace

std::string recordedHeader() {
    std::string header;
    for (const std::string_view name : kRecordedNumbers) header += std::string(name) + ",";
    return header + std::string(kStaleFactorColumn) + "," + std::string(kDeviceColumn);
}

std::array<uint64_t, kRecordedNumbers.size()> numbersOf(const TickInput& input, const DeviceReport& device) {
    const TickDecisions& decisions = input.decisions;
    uint64_t flags = uint64_t(decisions.milling_thrift) << kThriftShift;
    forEachFlag(input, [&](uint64_t bit, bool is_set) { flags |= is_set ? bit : 0; });
    return {flags,
            uint64_t(std::max(input.periods, 0)),
            input.placements,
            input.faults,
            device.state,
            device.stop_cause,
            device.fault_code,
            device.flags,
            decisions.tool,
            decisions.accuracy,
            decisions.most_samples};
}

bool takeNumbers(const std::array<uint64_t, kRecordedNumbers.size()>& numbers, TickInput& input,
                 DeviceReport& device) {
    const uint64_t flags = numbers[0];
    const bool are_small = std::ranges::all_of(
        numbers, [](uint64_t number) { return number <= std::numeric_limits<uint32_t>::max(); });
    if (!are_small || (flags & ~kAllFlags) || numbers[1] < 1 || numbers[1] > kMaxPeriods) return false;
    forEachFlag(input, [&](uint64_t bit, bool& is_set) { is_set = flags & bit; });
    input.decisions.milling_thrift = uint8_t(flags >> kThriftShift);
    input.periods = int32_t(numbers[1]);
    input.placements = uint32_t(numbers[2]);
    input.faults = uint32_t(numbers[3]);
    device.state = uint32_t(numbers[4]);
    device.stop_cause = uint32_t(numbers[5]);
    device.fault_code = uint32_t(numbers[6]);
    device.flags = uint32_t(numbers[7]);
    input.decisions.tool = uint32_t(numbers[8]);
    input.decisions.accuracy = uint32_t(numbers[9]);
    input.decisions.most_samples = uint32_t(numbers[10]);
    return true;
}

std::string textOfDevice(const DeviceCapabilities& device) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    unsigned char bytes[sizeof device];
    std::memcpy(bytes, &device, sizeof device);
    std::string text;
    for (const unsigned char byte : bytes) {
        text += kDigits[byte / kDigits.size()];
        text += kDigits[byte % kDigits.size()];
    }
    return text;
}

bool takeDevice(std::string_view text, DeviceCapabilities& device) {
    unsigned char bytes[sizeof device];
    if (text.size() != kDigitsPerByte * sizeof bytes) return false;
    for (size_t n = 0; n < sizeof bytes; ++n) {
        const char* const first = text.data() + kDigitsPerByte * n;
        const auto [end, error] = std::from_chars(first, first + kDigitsPerByte, bytes[n], 16);
        if (error != std::errc() || end != first + kDigitsPerByte) return false;
    }
    std::memcpy(&device, bytes, sizeof device);
    return isPlausible(device);
}

std::vector<TrajectoryRow> readTrajectory(std::istream& input, const std::string& name) {
    return Reader(input, name).read();
}

std::vector<TrajectoryRow> readTrajectory(const std::string& path) {
    if (std::filesystem::is_directory(path))
        throw UserError("trajectory " + path + " is a folder, not a CSV file");
    requireFile(path);
    std::ifstream file(path);
    if (!file) throw UserError("trajectory " + path + " cannot be opened (" + std::strerror(errno) + ")");
    return readTrajectory(file, path);
}

}  // namespace bonemill
