#include "haptic_server/recording/journal/input_columns.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "common/base/units.h"
#include "common/rt/clock.h"
#include "haptic_server/scene/trajectory/trajectory_reader.h"

namespace bonemill {
namespace {

template <class Column, size_t N>
void addAll(Column* column, const double (&values)[N]) {
    for (const double value : values) column->Add(typename Column::value_type(value));
}

uint64_t zigzag(uint64_t difference) noexcept {
    return (difference << 1) ^ uint64_t(int64_t(difference) >> 63);
}
uint64_t unzigzag(uint64_t code) noexcept {
    return (code >> 1) ^ (~(code & 1) + 1);
}

// What is left of a column of doubles when each tick's was predicted.
void putColumn(std::span<const uint64_t> residuals, std::string& out) {
    out.resize(residuals.size() * sizeof(uint64_t));
    size_t at = 0;
    for (size_t byte = 0; byte < sizeof(uint64_t); ++byte)
        for (const uint64_t residual : residuals) out[at++] = char(zigzag(residual) >> (8 * byte));
}

bool takeColumn(const std::string& planes, std::vector<uint64_t>& residuals) {
    const size_t count = residuals.size();
    if (planes.size() != count * sizeof(uint64_t)) return false;
    for (size_t n = 0; n < count; ++n) {
        uint64_t code = 0;
        for (size_t byte = 0; byte < sizeof(uint64_t); ++byte)
            code |= uint64_t(uint8_t(planes[byte * count + n])) << (8 * byte);
        residuals[n] = unzigzag(code);
    }
    return true;
}

double rotationPart(const double (&q)[4], double qw_before) noexcept {
    const double rest = 1 - q[1] * q[1] - q[2] * q[2] - q[3] * q[3];
    return std::copysign(std::sqrt(std::max(0.0, rest)), qw_before);
}

// The seven numbers of a pose in the order of their columns, of which the last is predicted from the others.
constexpr size_t kPoseColumns = 7;
double& poseNumber(TickInput& input, size_t column) noexcept {
    if (column < 3) return input.p_WT[column];
    return input.q_WT[column == kPoseColumns - 1 ? 0 : column - 2];
}
double poseNumber(const TickInput& input, size_t column) noexcept {
    return poseNumber(const_cast<TickInput&>(input), column);
}
double predicted(size_t column, const TickInput* before, const TickInput& now) noexcept {
    const double last = before ? poseNumber(*before, column) : 0.0;
    return column == kPoseColumns - 1 ? rotationPart(now.q_WT, last) : last;
}

std::string* poseColumn(journal::Inputs& inputs, size_t column) {
    const std::array<std::string*, kPoseColumns> all = {
        inputs.mutable_px(), inputs.mutable_py(), inputs.mutable_pz(), inputs.mutable_qx(),
        inputs.mutable_qy(), inputs.mutable_qz(), inputs.mutable_qw()};
    return all[column];
}
const std::string& poseColumn(const journal::Inputs& inputs, size_t column) {
    const std::array<const std::string*, kPoseColumns> all = {
        &inputs.px(), &inputs.py(), &inputs.pz(), &inputs.qx(), &inputs.qy(), &inputs.qz(), &inputs.qw()};
    return *all[column];
}

void encodePoses(std::span<const JournalTick> ticks, journal::Inputs& out) {
    std::vector<uint64_t> residuals(ticks.size());
    for (size_t column = 0; column < kPoseColumns; ++column) {
        for (size_t n = 0; n < ticks.size(); ++n) {
            const TickInput* const before = n > 0 ? &ticks[n - 1].input : nullptr;
            const double value = poseNumber(ticks[n].input, column);
            residuals[n] = std::bit_cast<uint64_t>(value) -
                           std::bit_cast<uint64_t>(predicted(column, before, ticks[n].input));
        }
        putColumn(residuals, *poseColumn(out, column));
    }
}

bool decodePoses(const journal::Inputs& inputs, std::span<JournalTick> ticks) {
    std::vector<uint64_t> residuals(ticks.size());
    for (size_t column = 0; column < kPoseColumns; ++column) {
        if (!takeColumn(poseColumn(inputs, column), residuals)) return false;
        for (size_t n = 0; n < ticks.size(); ++n) {
            const TickInput* const before = n > 0 ? &ticks[n - 1].input : nullptr;
            const double guess = predicted(column, before, ticks[n].input);
            poseNumber(ticks[n].input, column) =
                std::bit_cast<double>(std::bit_cast<uint64_t>(guess) + residuals[n]);
        }
    }
    return true;
}

template <class Ticks, class ValueOf>
void putRuns(const Ticks& ticks, journal::Runs& runs, ValueOf value_of) {
    for (const auto& tick : ticks) {
        const uint64_t value = value_of(tick);
        const int last = runs.values_size() - 1;
        if (last >= 0 && runs.values(last) == value) {
            runs.set_lengths(last, runs.lengths(last) + 1);
        } else {
            runs.add_values(value);
            runs.add_lengths(1);
        }
    }
}

// Calls set(tick, value), which says whether the value can be.
template <class Tick, class Set>
bool takeRuns(const journal::Runs& runs, std::span<Tick> ticks, Set set) {
    if (runs.values_size() != runs.lengths_size()) return false;
    size_t next = 0;
    for (int run = 0; run < runs.values_size(); ++run) {
        if (runs.lengths(run) > ticks.size() - next) return false;
        for (uint32_t n = 0; n < runs.lengths(run); ++n)
            if (!set(ticks[next++], runs.values(run))) return false;
    }
    return next == ticks.size();
}

// A column of the message, to be written and to be read.
using RunColumn =
    std::pair<journal::Runs* (journal::Inputs::*)(), const journal::Runs& (journal::Inputs::*)() const>;
using RecordedNumbers = std::array<uint64_t, kRecordedNumbers.size()>;

// In the order of kRecordedNumbers.
constexpr std::array<RunColumn, kRecordedNumbers.size()> kNumberColumns = {{
    {&journal::Inputs::mutable_flags, &journal::Inputs::flags},
    {&journal::Inputs::mutable_periods, &journal::Inputs::periods},
    {&journal::Inputs::mutable_placements, &journal::Inputs::placements},
    {&journal::Inputs::mutable_faults, &journal::Inputs::faults},
    {&journal::Inputs::mutable_device_state, &journal::Inputs::device_state},
    {&journal::Inputs::mutable_stop_cause, &journal::Inputs::stop_cause},
    {&journal::Inputs::mutable_device_fault_code, &journal::Inputs::device_fault_code},
    {&journal::Inputs::mutable_device_flags, &journal::Inputs::device_flags},
    {&journal::Inputs::mutable_tool, &journal::Inputs::tool},
    {&journal::Inputs::mutable_accuracy, &journal::Inputs::accuracy},
    {&journal::Inputs::mutable_most_samples, &journal::Inputs::most_samples},
}};

void encodeRuns(std::span<const JournalTick> ticks, journal::Inputs& out) {
    std::vector<RecordedNumbers> numbers;
    numbers.reserve(ticks.size());
    for (const JournalTick& tick : ticks) numbers.push_back(numbersOf(tick.input, tick.device));
    for (size_t column = 0; column < kNumberColumns.size(); ++column)
        putRuns(numbers, *(out.*kNumberColumns[column].first)(),
                [&](const RecordedNumbers& of_tick) { return of_tick[column]; });
    using T = const JournalTick&;
    putRuns(ticks, *out.mutable_buttons(), [](T t) { return t.buttons; });
    putRuns(ticks, *out.mutable_stale_factor_bits(),
            [](T t) { return std::bit_cast<uint64_t>(t.input.stale_factor); });
    putRuns(ticks, *out.mutable_bone_order(), [](T t) { return t.input.decisions.bone_order; });
    if (std::ranges::any_of(ticks, [](T t) { return t.input.decisions.tuning != 0; }))
        putRuns(ticks, *out.mutable_tuning(), [](T t) { return t.input.decisions.tuning; });
}

bool decodeNumbers(const journal::Inputs& in, std::span<JournalTick> ticks) {
    std::vector<RecordedNumbers> numbers(ticks.size());
    for (size_t column = 0; column < kNumberColumns.size(); ++column) {
        const auto set = [&](RecordedNumbers& of_tick, uint64_t value) {
            of_tick[column] = value;
            return true;
        };
        if (!takeRuns((in.*kNumberColumns[column].second)(), std::span(numbers), set)) return false;
    }
    for (size_t n = 0; n < ticks.size(); ++n)
        if (!takeNumbers(numbers[n], ticks[n].input, ticks[n].device)) return false;
    return true;
}

bool decodeRuns(const journal::Inputs& in, std::span<JournalTick> ticks) {
    using T = JournalTick&;
    const auto buttons = [](T t, uint64_t value) {
        t.buttons = uint32_t(value);
        return value <= UINT32_MAX;
    };
    const auto factor = [](T t, uint64_t bits) {
        t.input.stale_factor = std::bit_cast<double>(bits);
        return t.input.stale_factor >= 0 && t.input.stale_factor <= 1;
    };
    const auto order = [](T t, uint64_t value) {
        t.input.decisions.bone_order = value;
        return true;
    };
    const auto tuning = [](T t, uint64_t value) {
        t.input.decisions.tuning = uint32_t(value);
        return value <= UINT32_MAX;
    };
    if (in.has_tuning() && !takeRuns(in.tuning(), ticks, tuning)) return false;
    return decodeNumbers(in, ticks) && takeRuns(in.buttons(), ticks, buttons) &&
           takeRuns(in.stale_factor_bits(), ticks, factor) && takeRuns(in.bone_order(), ticks, order);
}

void encodeTimes(std::span<const JournalTick> ticks, journal::Inputs& out) {
    int64_t before = 0;
    for (const JournalTick& tick : ticks) {
        out.add_start_ns_steps(tick.start_ns - before);
        before = tick.start_ns;
    }
}

// Steps of anybody's could add up to more than there is.
bool decodeTimes(const journal::Inputs& inputs, std::span<JournalTick> ticks) {
    if (size_t(inputs.start_ns_steps_size()) != ticks.size()) return false;
    uint64_t start = 0;
    for (size_t n = 0; n < ticks.size(); ++n) {
        start += uint64_t(inputs.start_ns_steps(int(n)));
        ticks[n].start_ns = int64_t(start);
        if (ticks[n].start_ns < 0) return false;
    }
    return true;
}

void encodeChecks(std::span<const JournalTick> ticks, std::string& out) {
    for (const JournalTick& tick : ticks) out += char(tick.check);
    for (const JournalTick& tick : ticks) out += char(tick.check >> 8);
}

bool decodeChecks(const std::string& checks, std::span<JournalTick> ticks) {
    const size_t count = ticks.size();
    if (checks.size() != 2 * count) return false;
    for (size_t n = 0; n < count; ++n)
        ticks[n].check = uint16_t(uint8_t(checks[n]) | uint8_t(checks[count + n]) << 8);
    return true;
}

void encodeDevices(std::span<const JournalTick> ticks, journal::Inputs& out) {
    for (const JournalTick& tick : ticks) {
        if (!tick.input.has_other_device) continue;
        journal::OtherDevice* const other = out.add_other_devices();
        other->set_tick(tick.tick);
        other->set_capabilities(&tick.input.other_device, sizeof(DeviceCapabilities));
    }
}

bool decodeDevices(const journal::Inputs& inputs, std::span<JournalTick> ticks) {
    for (const journal::OtherDevice& other : inputs.other_devices()) {
        const uint64_t at = other.tick() - inputs.first_tick();  // wraps where it is before
        if (at >= ticks.size() || other.capabilities().size() != sizeof(DeviceCapabilities)) return false;
        TickInput& input = ticks[size_t(at)].input;
        input.has_other_device = true;
        std::memcpy(&input.other_device, other.capabilities().data(), sizeof(DeviceCapabilities));
        if (!isPlausible(input.other_device)) return false;
    }
    return true;
}

}  // namespace

void ResultColumns::add(const TickRecord& record) {
    if (isEmpty()) results_.set_first_tick(record.tick);
    results_.set_count(results_.count() + 1);
    addAll(results_.mutable_tool_m(), record.p_WT);
    addAll(results_.mutable_tool_q(), record.q_WT);
    addAll(results_.mutable_force_n(), record.f_hand_W);
    addAll(results_.mutable_torque_nm(), record.t_hand_W);
    results_.add_contacts(record.contacts);
    results_.add_penetration_m(float(record.max_penetration));
    results_.add_removed_mm3(float(record.removed * kPerCubicMillimetre));
    results_.add_faults(record.faults);
    results_.add_compute_us(float(microsecondsOfNs(double(record.compute_ns))));
    results_.add_events(record.effects.events);
    results_.add_burr_force_n(record.effects.burr_force);
    results_.add_temperature_c(record.effects.temperature);
    results_.add_damaged_mm3(float(double(record.effects.damaged_volume) * kPerCubicMillimetre));
    results_.add_protected_id(record.effects.protected_id);
    results_.add_protected_distance_m(record.effects.protected_distance);
}

journal::Results ResultColumns::take() {
    return std::exchange(results_, {});
}

JournalTick journalTickOf(const TickRecord& record, int64_t first_start_ns, uint16_t check) noexcept {
    return {record.tick, record.start_ns - first_start_ns, record.buttons, record.device, record.input,
            check};
}

void encodeInputs(std::span<const JournalTick> ticks, journal::Inputs& out) {
    out.Clear();
    out.set_first_tick(ticks.empty() ? 0 : ticks.front().tick);
    out.set_count(uint32_t(ticks.size()));
    encodePoses(ticks, out);
    encodeTimes(ticks, out);
    encodeRuns(ticks, out);
    encodeDevices(ticks, out);
    encodeChecks(ticks, *out.mutable_checks());
}

bool decodeInputs(const journal::Inputs& inputs, std::vector<JournalTick>& ticks) {
    if (inputs.count() == 0 || inputs.count() > kMaxTicksPerInputs) return false;
    if (inputs.first_tick() > UINT64_MAX - inputs.count()) return false;
    const size_t before = ticks.size();
    ticks.resize(before + inputs.count());
    const std::span<JournalTick> out = std::span(ticks).subspan(before);
    for (size_t n = 0; n < out.size(); ++n) out[n].tick = inputs.first_tick() + n;
    const bool is_good = decodePoses(inputs, out) && decodeTimes(inputs, out) && decodeRuns(inputs, out) &&
                         decodeDevices(inputs, out) && decodeChecks(inputs.checks(), out);
    if (!is_good) ticks.resize(before);
    return is_good;
}

}  // namespace bonemill
