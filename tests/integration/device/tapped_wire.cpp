#include "tests/integration/device/tapped_wire.h"

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <iterator>
#include <numeric>
#include <utility>

#include "common/rt/clock.h"
#include "common/rt/realtime.h"
#include "device_daemon/ares/wire/drive_state.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill::test {
namespace {

constexpr uint16_t kEmulatorPort = 4040;

// The loopback network has an address for every process, so that tests side by side do not meet.
wire::Endpoint emulatorOfThisProcess() {
    constexpr uint32_t kNetwork = 0x7f400000;  // 127.64.0.0
    return {kNetwork | (uint32_t(getpid()) & 0x3fffff), kEmulatorPort};
}

double normOf(const float (&force)[6]) {
    return std::sqrt(std::inner_product(std::begin(force), std::end(force), std::begin(force), 0.0));
}

WirePacket packetOf(const wire::JointCommand& command) {
    return {.is_command = true,
            .session = command.header.session,
            .sequence = command.header.sequence,
            .reflected = command.reflected_sequence,
            .force = normOf(command.force),
            .host_ns = int64_t(command.host_ns),
            .is_engaged = bool(command.flags & wire::kCommandEngaged)};
}

WirePacket packetOf(const wire::JointState& state) {
    return {.session = state.header.session,
            .sequence = state.header.sequence,
            .reflected = state.reflected_sequence,
            .force = normOf(state.force),
            .is_on = wire::driveStateOf(state.statusword) == wire::DriveState::kOperationEnabled,
            .holds_switch = bool(state.inputs & wire::kInputEnabled)};
}

}  // namespace

TappedWire::TappedWire()
    : emulator_(emulatorOfThisProcess()), thread_([this](const std::stop_token& stop) { relay(stop); }) {}

// The daemon starts the emulator that lies beside it. Ports are this wire's business.
std::string TappedWire::daemonIn(const std::string& folder) const {
    namespace fs = std::filesystem;
    const fs::path daemon = fs::path(folder) / "device_daemon", emulator = fs::path(folder) / "ares_emulator";
    fs::copy_file(binDir() + "/device_daemon", daemon);
    const std::string place = wire::textOf(emulator_);
    writeFile(emulator,
              "#!/bin/sh\necho 'listening on " + wire::textOf(socket_.local()) +
                  "'\n"
                  "drop=\n"
                  "for word; do\n"
                  "  shift\n"
                  "  if [ -n \"$drop\" ]; then drop=; continue; fi\n"
                  "  case $word in --port | --host-port) drop=1 ;; *) set -- \"$@\" \"$word\" ;; esac\n"
                  "done\n"
                  "exec " +
                  binDir() + "/ares_emulator \"$@\" --address " + place.substr(0, place.find(':')) +
                  " --port " + std::to_string(emulator_.port) + " >&2\n");
    fs::permissions(emulator, fs::perms::owner_all);
    return daemon;
}

std::vector<WirePacket> TappedWire::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(passed_, {});
}

void TappedWire::relay(const std::stop_token& stop) {
    makeThreadRealtime({});  // as far as the machine grants it, like those at its ends
    std::array<std::byte, wire::kMaxPacket> buffer;
    while (!stop.stop_requested()) {
        socket_.waitUntil(monotonicNowNs() + 20 * kNsPerMillisecond);
        wire::Endpoint source;
        for (auto bytes = socket_.receive(buffer, source); !bytes.empty();
             bytes = socket_.receive(buffer, source))
            pass(bytes, source);
    }
}

void TappedWire::pass(std::span<const std::byte> bytes, const wire::Endpoint& source) {
    if (source == emulator_) {
        if (const auto state = wire::open<wire::JointState>(bytes))
            passState(*state);
        else
            socket_.send(bytes, daemon_);
        return;
    }
    daemon_ = source;
    if (const auto command = wire::open<wire::JointCommand>(bytes)) note(packetOf(*command));
    socket_.send(bytes, emulator_);
}

void TappedWire::passState(wire::JointState state) {
    if (switch_ == EnablingSwitch::kHeld) state.inputs |= uint32_t(wire::kInputEnabled);
    wire::seal(state, state.header.session, state.header.sequence);
    note(packetOf(state));
    socket_.send(wire::bytesOf(state), daemon_);
}

void TappedWire::note(const WirePacket& packet) {
    const std::lock_guard lock(mutex_);
    passed_.push_back(packet);
}

}  // namespace bonemill::test
