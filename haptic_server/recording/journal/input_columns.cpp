#include "haptic_server/recording/journal/input_columns.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

namespace bonemill {
namespace {

constexpr uint64_t kRepeated = 1, kStale = 2, kPaused = 4, kWriteRefused = 8, kAllFlags = 15;

constexpr int32_t kMostPeriods = 10'000;

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

template <class ValueOf>
void putRuns(std::span<const JournalTick> ticks, journal::Runs& runs, ValueOf value_of) {
    for (const JournalTick& tick : ticks) {
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
template <class Set>
bool takeRuns(const journal::Runs& runs, std::span<JournalTick> ticks, Set set) {
    if (runs.values_size() != runs.lengths_size()) return false;
    size_t next = 0;
    for (int run = 0; run < runs.values_size(); ++run) {
        if (runs.lengths(run) > ticks.size() - next) return false;
        for (uint32_t n = 0; n < runs.lengths(run); ++n)
            if (!set(ticks[next++], runs.values(run))) return false;
    }
    return next == ticks.size();
}

uint64_t flagsOf(const TickInput& input) noexcept {
    return (input.is_repeated ? kRepeated : 0) | (input.is_stale ? kStale : 0) |
           (input.decisions.is_milling_paused ? kPaused : 0) |
           (input.decisions.is_write_refused ? kWriteRefused : 0);
}

bool setFlags(TickInput& input, uint64_t flags) noexcept {
    input.is_repeated = flags & kRepeated;
    input.is_stale = flags & kStale;
    input.decisions.is_milling_paused = flags & kPaused;
    input.decisions.is_write_refused = flags & kWriteRefused;
    return (flags & ~kAllFlags) == 0;
}

bool setFactor(TickInput& input, uint64_t bits) noexcept {
    input.stale_factor = std::bit_cast<double>(bits);
    return input.stale_factor >= 0 && input.stale_factor <= 1;
}

bool setPeriods(TickInput& input, uint64_t periods) noexcept {
    input.periods = int32_t(periods);
    return periods >= 1 && periods <= uint64_t(kMostPeriods);
}

bool setNarrow(uint32_t& out, uint64_t value) noexcept {
    out = uint32_t(value);
    return value <= UINT32_MAX;
}

// Both lists go together: each column's place in the message, and in a tick.
void encodeRuns(std::span<const JournalTick> ticks, journal::Inputs& out) {
    using T = const JournalTick&;
    putRuns(ticks, *out.mutable_buttons(), [](T t) { return t.buttons; });
    putRuns(ticks, *out.mutable_placements(), [](T t) { return t.input.placements; });
    putRuns(ticks, *out.mutable_device_state(), [](T t) { return t.device.state; });
    putRuns(ticks, *out.mutable_stop_cause(), [](T t) { return t.device.stop_cause; });
    putRuns(ticks, *out.mutable_device_fault_code(), [](T t) { return t.device.fault_code; });
    putRuns(ticks, *out.mutable_device_flags(), [](T t) { return t.device.flags; });
    putRuns(ticks, *out.mutable_faults(), [](T t) { return t.input.faults; });
    putRuns(ticks, *out.mutable_periods(), [](T t) { return uint64_t(t.input.periods); });
    putRuns(ticks, *out.mutable_flags(), [](T t) { return flagsOf(t.input); });
    putRuns(ticks, *out.mutable_stale_factor_bits(),
            [](T t) { return std::bit_cast<uint64_t>(t.input.stale_factor); });
    putRuns(ticks, *out.mutable_tool(), [](T t) { return t.input.decisions.tool; });
    putRuns(ticks, *out.mutable_accuracy(), [](T t) { return t.input.decisions.accuracy; });
    putRuns(ticks, *out.mutable_most_samples(), [](T t) { return t.input.decisions.most_samples; });
    putRuns(ticks, *out.mutable_bone_order(), [](T t) { return t.input.decisions.bone_order; });
}

bool decodeRuns(const journal::Inputs& in, std::span<JournalTick> ticks) {
    using T = JournalTick&;
    const auto narrow = [&](const journal::Runs& runs, auto place) {
        return takeRuns(runs, ticks, [&](T t, uint64_t v) { return setNarrow(place(t), v); });
    };
    return narrow(in.buttons(), [](T t) -> uint32_t& { return t.buttons; }) &&
           narrow(in.placements(), [](T t) -> uint32_t& { return t.input.placements; }) &&
           narrow(in.device_state(), [](T t) -> uint32_t& { return t.device.state; }) &&
           narrow(in.stop_cause(), [](T t) -> uint32_t& { return t.device.stop_cause; }) &&
           narrow(in.device_fault_code(), [](T t) -> uint32_t& { return t.device.fault_code; }) &&
           narrow(in.device_flags(), [](T t) -> uint32_t& { return t.device.flags; }) &&
           narrow(in.faults(), [](T t) -> uint32_t& { return t.input.faults; }) &&
           narrow(in.tool(), [](T t) -> uint32_t& { return t.input.decisions.tool; }) &&
           narrow(in.accuracy(), [](T t) -> uint32_t& { return t.input.decisions.accuracy; }) &&
           narrow(in.most_samples(), [](T t) -> uint32_t& { return t.input.decisions.most_samples; }) &&
           takeRuns(in.periods(), ticks, [](T t, uint64_t v) { return setPeriods(t.input, v); }) &&
           takeRuns(in.flags(), ticks, [](T t, uint64_t v) { return setFlags(t.input, v); }) &&
           takeRuns(in.stale_factor_bits(), ticks, [](T t, uint64_t v) { return setFactor(t.input, v); }) &&
           takeRuns(in.bone_order(), ticks, [](T t, uint64_t v) {
               t.input.decisions.bone_order = v;
               return true;
           });
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
    if (inputs.count() == 0 || inputs.count() > kMostTicksPerInputs) return false;
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
