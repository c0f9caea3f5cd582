#include "device_daemon/app/device_choice.h"

#include <charconv>

#include "common/rt/clock.h"
#include "common/user_error.h"
#include "device_daemon/ares/ares_device.h"
#include "device_daemon/pointer/pointer_device.h"
#include "device_daemon/wire/udp_joint_device.h"
#include "device_daemon/wire/udp_pose_device.h"

namespace bonemill {
namespace {

constexpr char kLoopback[] = "127.0.0.1";

// ARES with its joints behind the wire.
class WiredAres final : public HapticDevice {
  public:
    WiredAres(const AresConfig& config, const wire::HostSessionConfig& host) : joints_(host), ares_(config, joints_) {}
    DeviceCapabilities capabilities() const noexcept override { return ares_.capabilities(); }
    uint32_t capabilitiesVersion() const noexcept override { return ares_.capabilitiesVersion(); }
    bool hasClock() const noexcept override { return ares_.hasClock(); }
    bool waitForSample(int64_t deadline_ns) noexcept override { return ares_.waitForSample(deadline_ns); }
    bool read(double elapsed, DeviceReading& reading) noexcept override { return ares_.read(elapsed, reading); }
    void write(const DeviceOrder& order) noexcept override { ares_.write(order); }

  private:
    UdpJointDevice joints_;
    AresDevice ares_;
};

// Splits "127.0.0.1:5000". Throws UserError.
wire::HostSessionConfig hostOf(const std::string& word, const std::string& endpoint) {
    const size_t colon = endpoint.rfind(':');
    uint16_t port = 0;
    const char* const end = endpoint.data() + endpoint.size();
    const bool has_port = colon != std::string::npos &&
                          std::from_chars(endpoint.data() + colon + 1, end, port).ptr == end && port != 0;
    if (!has_port)
        throw UserError("--device " + word + ": give address and port, as in " + word + ":192.168.1.5:5000");
    return {.controller = wire::endpointOf(endpoint.substr(0, colon), port), .seed = uint64_t(monotonicNowNs())};
}

wire::HostSessionConfig hostOf(const ChildProgram& program) {
    return hostOf("", std::string(kLoopback) + ":" + std::to_string(program.port()));
}

ChosenDevice simulated(const DeviceSetup& setup, const DaemonOptions& options) {
    std::vector<std::string> words{"--scene", options.scene, "--log-level", options.log_level};
    if (options.seconds) words.insert(words.end(), {"--seconds", std::to_string(*options.seconds)});
    if (options.hold) words.push_back("--hold");
    // Without real time its host may be late now and then, and nobody is hurt by it.
    if (options.best_effort_realtime) words.insert(words.end(), {"--best-effort-rt", "--watchdog-ms", "30"});
    auto program = std::make_unique<ChildProgram>("ares_emulator", words);
    auto device = std::make_unique<WiredAres>(setup.ares, hostOf(*program));
    return {std::move(program), std::move(device)};
}

ChosenDevice bridged(const std::string& program_name) {
    auto program = std::make_unique<ChildProgram>(program_name, std::vector<std::string>{});
    auto device = std::make_unique<UdpPoseDevice>(hostOf(*program));
    return {std::move(program), std::move(device)};
}

ChosenDevice pointer(const DeviceSetup& setup, const DaemonOptions& options) {
    return {nullptr, std::make_unique<PointerDevice>(PointerConfig{.domain = options.domain,
                                                                   .session = options.session,
                                                                   .X_WD = setup.X_WD,
                                                                   .workspace_scale = setup.workspace_scale,
                                                                   .X_DT_start = setup.X_DT_start})};
}

}  // namespace

const char* deviceChoices() {
    return "The hand: auto (the best that is there), simulated (a scripted hand on the emulated ARES), "
           "ares:ADDRESS:PORT (a controller that speaks docs/ares_link.md), bridge:ADDRESS:PORT (a program that speaks "
           "its pose packets), force-dimension, touch, haply, spacemouse, gamepad, pointer (the mouse in a viewer)";
}

ChosenDevice chooseDevice(const DeviceSetup& setup, const DaemonOptions& options) {
    const std::string kind = options.device.substr(0, options.device.find(':'));
    const std::string endpoint = kind.size() < options.device.size() ? options.device.substr(kind.size() + 1) : "";
    if (kind == "ares") return {nullptr, std::make_unique<WiredAres>(setup.ares, hostOf(kind, endpoint))};
    if (kind == "bridge") return {nullptr, std::make_unique<UdpPoseDevice>(hostOf(kind, endpoint))};
    if (!endpoint.empty()) throw UserError("--device " + options.device + ": only ares and bridge take an address");
    if (kind == "simulated") return simulated(setup, options);
    if (kind == "force-dimension") return bridged("bonemill_bridge_force_dimension");
    if (kind == "touch") return bridged("bonemill_bridge_touch");
    if (kind == "haply") return bridged("bonemill_bridge_haply");
    if (kind == "pointer" || kind == "auto") return pointer(setup, options);
    throw UserError("--device " + options.device + ": there is no such device (see device_daemon --help)");
}

}  // namespace bonemill
