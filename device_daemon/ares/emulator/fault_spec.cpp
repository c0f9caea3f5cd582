#include "device_daemon/ares/emulator/fault_spec.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "common/base/units.h"
#include "common/base/user_error.h"

namespace bonemill {
namespace {

constexpr size_t kMaxUnderWay = 1024;
constexpr double kOvertakenPeriods = 1.5;

struct KindWords {
    std::string_view name;
    FaultKind kind;
    bool has_axis;
    std::string_view number;  // the name of its number, or nothing
    std::string_view meaning;
};

constexpr KindWords kKinds[] = {
    {"drop", FaultKind::kDrop, false, "", "packets vanish"},
    {"delay", FaultKind::kDelay, false, "MS", "packets come so much later"},
    {"duplicate", FaultKind::kDuplicate, false, "", "packets come twice"},
    {"reorder", FaultKind::kReorder, false, "", "packets are overtaken by the next"},
    {"corrupt", FaultKind::kCorrupt, false, "", "one bit of a packet is flipped"},
    {"unplug", FaultKind::kUnplug, false, "", "silence in both directions"},
    {"stuck-encoder", FaultKind::kStuckEncoder, true, "", "the axis says that it stands still"},
    {"encoder-offset", FaultKind::kEncoderOffset, true, "MM", "the axis is off by so much"},
    {"dead-amplifier", FaultKind::kDeadAmplifier, true, "", "the axis gives no force"},
    {"emergency-stop", FaultKind::kEmergencyStop, false, "", "the emergency stop chain is open"},
    {"over-temperature", FaultKind::kOverTemperature, false, "", "a motor is too hot"},
};

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
    throw UserError("--fault " + text + ": " + why + " (see ares_emulator --help)");
}

// Cuts off what follows the last `mark`, which may be missing.
std::optional<std::string_view> cutTail(std::string_view& text, char mark) {
    const size_t at = text.rfind(mark);
    if (at == std::string_view::npos) return std::nullopt;
    const std::string_view tail = text.substr(at + 1);
    text = text.substr(0, at);
    return tail;
}

double numberOf(std::string_view digits, double least, double most, const std::string& text) {
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || !(value >= least && value <= most)) {
        refuse(text, "'" + std::string(digits) + "' is no number that fits there");
    }
    return value;
}

void readTimes(std::string_view times, const std::string& text, FaultSpec& fault) {
    if (const auto duration = cutTail(times, '+')) fault.duration = numberOf(*duration, 0, 1e6, text);
    fault.start = numberOf(times, 0, 1e6, text);
}

void readNumber(const KindWords& words, double value, FaultSpec& fault) {
    if (words.kind == FaultKind::kDelay) fault.delay = kMilli * value;
    if (words.kind == FaultKind::kEncoderOffset) fault.offset = kMillimetre * value;
}

}  // namespace

FaultSpec faultSpecOf(const std::string& text) {
    std::string_view rest = text;
    FaultSpec fault;
    const auto percent = cutTail(rest, '%');
    if (percent) fault.chance = numberOf(*percent, 0, 100, text) / 100;
    if (const auto times = cutTail(rest, '@')) readTimes(*times, text, fault);

    const std::string_view name = rest.substr(0, rest.find(':'));
    for (const KindWords& words : kKinds) {
        if (words.name != name) continue;
        fault.kind = words.kind;
        if (!words.number.empty()) {
            const auto number = cutTail(rest, ':');
            if (!number) refuse(text, "its number is missing");
            readNumber(words, numberOf(*number, -1e4, 1e4, text), fault);
        }
        if (words.has_axis) {
            const auto axis = cutTail(rest, ':');
            if (!axis) refuse(text, "the axis (1 to 6) is missing");
            fault.axis = int(numberOf(*axis, 1, 6, text)) - 1;
        }
        if (rest != name) refuse(text, "it says too much");
        if (percent && !fault.isOfPackets()) refuse(text, "only packets have a chance");
        if (fault.delay < 0) refuse(text, "nothing comes before it was sent");
        return fault;
    }
    refuse(text, "there is no such fault");
}

std::string faultHelp() {
    std::string help =
        "Faults (--fault KIND[:ARGUMENT...][@START_S[+DURATION_S]][%PERCENT], any number of them):\n";
    for (const KindWords& words : kKinds) {
        std::string usage = std::string(words.name) + (words.has_axis ? ":AXIS" : "");
        if (!words.number.empty()) usage += ":" + std::string(words.number);
        usage.resize(24, ' ');
        help += "  " + usage + std::string(words.meaning) + "\n";
    }
    return help +
           "START counts from the moment when the hand is engaged first; without it the fault is there from "
           "the "
           "beginning.\nPERCENT is the chance of each packet in each direction. AXIS is 1 to 6. The same "
           "--seed "
           "befalls the same packets.";
}

FaultyWire::FaultyWire(const std::vector<FaultSpec>& faults, uint32_t seed, int64_t period_ns)
    : random_(seed), period_ns_(period_ns), under_way_(kMaxUnderWay) {
    std::copy_if(faults.begin(), faults.end(), std::back_inserter(faults_),
                 [](const FaultSpec& fault) { return fault.isOfPackets(); });
}

void FaultyWire::put(std::span<const std::byte> bytes, const wire::Endpoint& other, double engaged_s,
                     int64_t now_ns) noexcept {
    Datagram changed;
    changed.size = std::min(bytes.size(), changed.bytes.size());
    std::copy_n(bytes.begin(), changed.size, changed.bytes.begin());
    int64_t due_ns = now_ns;
    int copies = 1;
    for (const FaultSpec& fault : faults_) {
        if (!happens(fault, engaged_s)) continue;
        if (fault.kind == FaultKind::kDrop || fault.kind == FaultKind::kUnplug) copies = 0;
        if (fault.kind == FaultKind::kDuplicate) copies *= 2;
        if (fault.kind == FaultKind::kDelay) due_ns += std::llround(fault.delay * double(kNsPerSecond));
        if (fault.kind == FaultKind::kReorder) due_ns += std::llround(kOvertakenPeriods * double(period_ns_));
        if (fault.kind == FaultKind::kCorrupt && changed.size > 0) {
            const size_t bit = random_() % (8 * changed.size);
            changed.bytes[bit / 8] ^= std::byte(1u << bit % 8);
        }
    }
    for (int i = 0; i < copies; ++i) enter(changed.content(), other, due_ns);
}

bool FaultyWire::happens(const FaultSpec& fault, double engaged_s) noexcept {
    constexpr double kRange = double(std::mt19937::max()) + 1;
    return fault.isActive(engaged_s) && double(random_()) < fault.chance * kRange;
}

void FaultyWire::enter(std::span<const std::byte> bytes, const wire::Endpoint& other,
                       int64_t due_ns) noexcept {
    if (count_ == under_way_.size()) return;
    Datagram& place = under_way_[count_++];
    place.due_ns = due_ns;
    place.other = other;
    place.size = bytes.size();
    std::copy(bytes.begin(), bytes.end(), place.bytes.begin());
}

// Of those that are due together the one that entered first.
FaultyWire::Datagram* FaultyWire::firstDue() noexcept {
    const auto end = under_way_.begin() + std::ptrdiff_t(count_);
    const auto first = std::min_element(
        under_way_.begin(), end, [](const Datagram& a, const Datagram& b) { return a.due_ns < b.due_ns; });
    return first == end ? nullptr : &*first;
}

bool FaultyWire::take(Datagram& datagram, int64_t now_ns) noexcept {
    Datagram* first = firstDue();
    if (!first || first->due_ns > now_ns) return false;
    datagram = *first;
    std::move(first + 1, under_way_.data() + count_, first);
    --count_;
    return true;
}

int64_t FaultyWire::nextDueNs() const noexcept {
    int64_t due_ns = std::numeric_limits<int64_t>::max();
    for (size_t i = 0; i < count_; ++i) due_ns = std::min(due_ns, under_way_[i].due_ns);
    return due_ns;
}

}  // namespace bonemill
