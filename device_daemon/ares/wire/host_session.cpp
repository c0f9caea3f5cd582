#include "device_daemon/ares/wire/host_session.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <type_traits>

#include "common/device_messages/device_messages.h"
#include "common/rt/clock.h"

namespace bonemill::wire {
namespace {

// A watchdog that is shorter than N periods of the states would trip at once.
constexpr uint64_t kPeriodsPerWatchdog = 2;

const char* negativeFigure(const Describe& d) noexcept {
    const std::pair<const char*, double> figures[] = {{"max_force", d.max_force},
                                                      {"max_torque", d.max_torque},
                                                      {"max_stiffness", d.max_stiffness},
                                                      {"max_rotation_stiffness", d.max_rotation_stiffness},
                                                      {"workspace_radius", d.workspace_radius},
                                                      {"max_actuator_force", d.max_actuator_force},
                                                      {"encoder_step", d.encoder_step},
                                                      {"stroke", d.stroke}};
    for (const auto& [name, figure] : figures)
        if (figure < 0) return name;
    return nullptr;
}

// Joints have motors of their own; a pose has none.
template <class Packets>
const char* figureOfAnotherKind(const Describe& d) noexcept {
    if constexpr (std::is_same_v<Packets, JointPackets>) {
        if (d.stroke == 0) return "stroke";
        return d.max_actuator_force == 0 ? "max_actuator_force" : nullptr;
    } else {
        return d.max_actuator_force != 0 ? "max_actuator_force" : nullptr;
    }
}

// Names the first field that no controller of this kind has; null: the description makes sense.
template <class Packets>
const char* implausibleFigure(const Describe& d) noexcept {
    if (const char* figure = negativeFigure(d)) return figure;
    if (d.watchdog_us < kShortestWatchdogUs || d.watchdog_us > kLongestWatchdogUs) return "watchdog_us";
    if (uint64_t(d.rate_hz) * d.watchdog_us < kPeriodsPerWatchdog * 1'000'000) return "rate_hz";
    if (d.kind >= kDeviceKindCount) return "kind";
    return figureOfAnotherKind<Packets>(d);
}

// A controller that knows nothing of its handle, or of this, answers with the short one.
std::optional<Description> openDescription(std::span<const std::byte> bytes) noexcept {
    if (const auto known = open<Description>(bytes)) return known;
    const auto describe = open<Describe>(bytes);
    return describe ? std::optional(Description{*describe, {}, 0, 0}) : std::nullopt;
}

bool saysTheSame(Description a, Description b) noexcept {
    for (Description* const d : {&a, &b}) {
        d->describe.header = {};
        d->describe.crc = d->reserved0 = d->crc = 0;
    }
    return std::ranges::equal(bytesOf(a), bytesOf(b));
}

}  // namespace

template <class Packets>
HostSession<Packets>::HostSession(const HostSessionConfig& config) noexcept
    : config_(config), random_(config.seed) {
    beginToAsk();
}

template <class Packets>
bool HostSession<Packets>::take(std::span<const std::byte> bytes, const Endpoint& source,
                                int64_t now_ns) noexcept {
    if (source != config_.controller) {
        flow_.reject(false);
        return false;
    }
    if (claimedType(bytes) == PacketType::kDescribe) {
        takeDescription(bytes, now_ns);
        return false;
    }
    return takeState(bytes, now_ns);
}

template <class Packets>
bool HostSession<Packets>::takeState(std::span<const std::byte> bytes, int64_t now_ns) noexcept {
    const auto state = openWhole<State>(bytes);
    if (!is_described_ || !state || state->header.session != session_) {
        flow_.reject(is_described_);
        return false;
    }
    if (!isSound(*state)) {
        nonsense_count_ += flow_.skip(state->header.sequence);
        flow_.reject(true);
        return false;
    }
    if (!flow_.accept(state->header.sequence, state->reflected_sequence, sequence_,
                      int64_t(state->controller_ns), now_ns))
        return false;
    state_ = *state;
    has_state_ = true;
    return true;
}

template <class Packets>
void HostSession<Packets>::takeDescription(std::span<const std::byte> bytes, int64_t now_ns) noexcept {
    const auto description = openDescription(bytes);
    const bool was_asked = request_.header.session == session_;
    if (!description || !was_asked || description->describe.header.session != session_) {
        flow_.reject(is_described_);
        return;
    }
    if (is_described_) {
        const bool is_new = flow_.skip(description->describe.header.sequence);
        const Description known{.describe = description_, .handle = handle_};
        // The same again answers a question that was asked twice; another one is another device's.
        if (is_new && !saysTheSame(*description, known)) beginToAsk();
        return;
    }
    refused_figure_ = implausibleFigure<Packets>(description->describe);
    if (refused_figure_) {
        flow_.reject(false);
        return;
    }
    description_ = description->describe;
    handle_ = description->handle;
    ++description_count_;
    is_described_ = true;
    flow_.begin(description_.header.sequence, request_sequence_, kNsPerSecond / description_.rate_hz, now_ns);
}

template <class Packets>
const DescribeRequest* HostSession<Packets>::requestDue(int64_t now_ns) noexcept {
    if (is_described_ && isLost(now_ns)) beginToAsk();
    if (is_described_ || now_ns < ask_at_ns_) return nullptr;
    ask_at_ns_ = now_ns + kAskEveryNs;
    request_ = {};
    request_.host_ns = uint64_t(now_ns);
    request_.watchdog_us = config_.watchdog_us;
    request_.understands = kUnderstandsHandle;
    wire::seal(request_, session_, ++sequence_);
    return &request_;
}

template <class Packets>
bool HostSession<Packets>::seal(Command& command, int64_t now_ns) noexcept {
    if (!is_described_) return false;
    command.reflected_sequence = flow_.newestSequence();
    command.host_ns = uint64_t(now_ns);
    wire::seal(command, session_, ++sequence_);
    return true;
}

template <class Packets>
bool HostSession<Packets>::isLost(int64_t now_ns) const noexcept {
    return !is_described_ || now_ns - flow_.newestNs() > description_.watchdog_us * kNsPerMicrosecond;
}

template <class Packets>
void HostSession<Packets>::beginToAsk() noexcept {
    session_ = nextSessionNumber();
    sequence_ = 0;
    request_sequence_ = 1;
    ask_at_ns_ = 0;
    is_described_ = false;
    has_state_ = false;
}

// splitmix64: every state of the generator gives another number.
template <class Packets>
uint32_t HostSession<Packets>::nextSessionNumber() noexcept {
    uint32_t number = 0;
    while (number == 0 || number == session_) {
        random_ += 0x9e3779b97f4a7c15u;
        uint64_t z = random_;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        number = uint32_t((z ^ (z >> 31)) >> 32);
    }
    return number;
}

template class HostSession<JointPackets>;
template class HostSession<PosePackets>;

uint64_t randomSeed() {
    std::random_device device;
    return (uint64_t(device()) << 32) | device();
}

template <class Packets>
bool HostLink<Packets>::waitForState(int64_t deadline_ns) noexcept {
    while (true) {
        const int64_t now_ns = monotonicNowNs();
        if (poll(now_ns)) return true;
        if (now_ns >= deadline_ns) return false;
        socket_.waitUntil(std::min(deadline_ns, now_ns + kAskEveryNs));
    }
}

template <class Packets>
bool HostLink<Packets>::poll(int64_t now_ns) noexcept {
    bool has_new = false;
    for (int i = 0; i < kDatagramsAtOnce; ++i) {
        std::array<std::byte, kMaxPacket> buffer;
        Endpoint source;
        int64_t waited_ns = 0;
        const auto bytes = socket_.receive(buffer, source, &waited_ns);
        if (bytes.empty()) break;
        has_new |= session_.take(bytes, source, now_ns - waited_ns);
    }
    if (const DescribeRequest* request = session_.requestDue(now_ns)) {
        socket_.send(bytesOf(*request), session_.controller());
    }
    return has_new;
}

template <class Packets>
bool HostLink<Packets>::send(Command& command, int64_t now_ns) noexcept {
    return session_.seal(command, now_ns) && socket_.send(bytesOf(command), session_.controller());
}

template class HostLink<JointPackets>;
template class HostLink<PosePackets>;

}  // namespace bonemill::wire
