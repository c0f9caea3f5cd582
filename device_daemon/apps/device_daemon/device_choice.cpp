#include "device_daemon/apps/device_daemon/device_choice.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <charconv>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "common/base/user_error.h"
#include "common/text/printed_text.h"
#include "device_daemon/ares/ares_device/wired_ares.h"
#include "device_daemon/ares/driver/udp_pose_device.h"
#include "device_daemon/hands/input/gamepad_device.h"
#include "device_daemon/hands/input/pedal_source.h"
#include "device_daemon/hands/input/spacemouse_device.h"
#include "device_daemon/hands/pointer/pointer_device.h"

namespace bonemill {
namespace {

// A library that hangs must not hold the list.
constexpr char kProbe[] = "timeout --signal=KILL 5 ";

// Asks a bridge whether its vendor's library is there.
ArmLibrary libraryOf(const std::string& bridge) {
    std::string path;
    try {
        path = programPath(bridge);
    } catch (const std::exception& error) {
        return {.loads = false, .why_not = error.what()};
    }
    FILE* const output = popen((kProbe + bonemill::quoted(path) + " --probe 2>&1 >/dev/null").c_str(), "r");
    if (!output) return {.loads = false, .why_not = "no process for " + bridge};
    char line[512] = "";
    std::string first;
    while (std::fgets(line, sizeof(line), output))
        if (first.empty()) first = line;
    const int status = pclose(output);
    while (!first.empty() && (first.back() == '\n' || first.back() == ' ')) first.pop_back();
    if (first.rfind("error: ", 0) == 0) first.erase(0, 7);
    return {.loads = status == 0, .why_not = status == 0 ? "" : first};
}

// A device with a foot pedal beside it: the pedal's buttons count as the device's own. The path is that of
// /dev/input; those in by-id stay the same when the pedal is plugged in again.
class PedalledDevice final : public HapticDevice {
  public:
    PedalledDevice(std::unique_ptr<HapticDevice> device, const std::string& pedal_path)
        : device_(std::move(device)), pedal_([pedal_path] { return openEvdev(pedal_path, true); }) {}

    DeviceCapabilities capabilities() const noexcept override { return device_->capabilities(); }
    uint32_t capabilitiesVersion() const noexcept override { return device_->capabilitiesVersion(); }
    const char* refusedFigure() const noexcept override { return device_->refusedFigure(); }
    bool hasClock() const noexcept override { return device_->hasClock(); }
    bool waitForSample(int64_t deadline_ns) noexcept override { return device_->waitForSample(deadline_ns); }
    bool read(double elapsed, DeviceReading& reading) noexcept override {
        const bool is_heard = device_->read(elapsed, reading);
        reading.buttons |= pedal_.buttons();
        return is_heard;
    }
    void write(const DeviceOrder& order) noexcept override { device_->write(order); }
    void beginAttempt() noexcept override { device_->beginAttempt(); }
    void followRun(uint64_t epoch) noexcept override { device_->followRun(epoch); }
    std::string refusal() const override { return device_->refusal(); }

  private:
    std::unique_ptr<HapticDevice> device_;
    PedalSource pedal_;
};

constexpr char kThisMachine[] = "127.0.0.1";

// Splits "127.0.0.1:5000". Throws UserError.
UdpDeviceConfig wireTo(const std::string& word, const std::string& endpoint) {
    const size_t colon = endpoint.rfind(':');
    uint16_t port = 0;
    const char* const end = endpoint.data() + endpoint.size();
    const bool has_port = colon != std::string::npos &&
                          std::from_chars(endpoint.data() + colon + 1, end, port).ptr == end && port != 0;
    if (!has_port)
        throw UserError("--device " + word + ": give address and port, as in " + word + ":192.168.1.5:5000");
    const std::string address = endpoint.substr(0, colon);
    const bool is_here = address.rfind("127.", 0) == 0;
    return {.controller = wire::endpointOf(address, port),
            .socket = wire::UdpSocket(wire::endpointOf(is_here ? kThisMachine : "0.0.0.0", 0))};
}

// A program of the daemon's own, and the way to it; it listens to no other program.
struct OwnProgram {
    OwnProgram(const std::string& name, std::vector<std::string> words) {
        words.insert(words.end(), {"--host-port", std::to_string(wire.socket.local().port)});
        program = std::make_unique<ChildProgram>(name, std::move(words));
        wire.controller = wire::endpointOf(kThisMachine, program->port());
    }
    UdpDeviceConfig wire{.controller = {}};
    std::unique_ptr<ChildProgram> program;
};

ChosenDevice simulated(const FollowedScene& scene, const DaemonOptions& options) {
    std::vector<std::string> words{"--scene", scene.file, "--log-level", options.log_level};
    if (options.seconds) words.insert(words.end(), {"--seconds", std::to_string(*options.seconds)});
    if (options.hold) words.push_back("--hold");
    // Its host may be late now and then, which is harmless.
    if (options.is_strict_realtime)
        words.push_back("--strict-rt");
    else
        words.insert(words.end(), {"--watchdog-ms", "30"});
    OwnProgram own("ares_emulator", words);
    own.program->listens();
    auto device = std::make_unique<WiredAres>(scene.setup.simulated_ares, std::move(own.wire));
    return {std::move(own.program), std::move(device), true};
}

ChosenDevice bridged(const std::string& program_name, std::vector<std::string> words = {}) {
    OwnProgram own(program_name, std::move(words));
    auto device = std::make_unique<UdpPoseDevice>(std::move(own.wire));
    return {.program = std::move(own.program), .device = std::move(device), .is_of_scene = false};
}

ChosenDevice pointer(const FollowedScene& scene, const DaemonOptions& options) {
    const DeviceSetup& setup = scene.setup;
    return {nullptr, std::make_unique<PointerDevice>(PointerConfig{.domain = options.domain,
                                                                   .session = options.session,
                                                                   .epoch = scene.epoch,
                                                                   .X_WD = setup.X_WD,
                                                                   .hand_space = setup.hand_space,
                                                                   .X_DT_start = setup.X_DT_start})};
}

// Only some kinds take an address or a path behind their name.
ChosenDevice deviceOf(const std::string& word, const FollowedScene& scene, const DaemonOptions& options) {
    const DeviceSetup& setup = scene.setup;
    const std::string kind = word.substr(0, word.find(':'));
    const std::string place = kind.size() < word.size() ? word.substr(kind.size() + 1) : "";
    spdlog::info("the hand is {}", word);
    if (kind == "ares") return {nullptr, std::make_unique<WiredAres>(setup.ares, wireTo(kind, place))};
    if (kind == "bridge")
        return {.program = nullptr,
                .device = std::make_unique<UdpPoseDevice>(wireTo(kind, place)),
                .is_of_scene = false};
    if (kind == "gamepad")
        return {nullptr, std::make_unique<GamepadDevice>(setup.rates, setup.X_DT_start, gamepadAt(place))};
    if (kind == "ros2")
        return bridged("bonemill_bridge_ros2", place.empty() ? std::vector<std::string>{}
                                                             : std::vector<std::string>{"--device", place});
    if (!place.empty())
        throw UserError("--device " + word + ": only ares, bridge, gamepad and ros2 take more than a word");
    if (kind == kScriptedHand) return simulated(scene, options);
    if (kind == "force-dimension") return bridged("bonemill_bridge_force_dimension");
    if (kind == "touch") return bridged("bonemill_bridge_touch");
    if (kind == "haply") return bridged("bonemill_bridge_haply");
    if (kind == "igtl") return bridged("bonemill_bridge_igtl");
    if (kind == "spacemouse")
        return {nullptr, std::make_unique<SpaceMouseDevice>(setup.rates, setup.X_DT_start)};
    if (kind == "pointer") return pointer(scene, options);
    throw UserError("--device " + word + ": there is no such device (see device_daemon --help)");
}

// Returns the word for --device of the first usable one: arms come before SpaceMouse, gamepad and mouse.
std::string bestOf(const std::vector<ListedDevice>& devices) {
    for (const ListedDevice& device : devices)
        if (device.usable && !device.word.empty()) return device.word;
    return "pointer";
}

}  // namespace

std::vector<ListedDevice> foundDevices() {
    return listDevices(gatherDeviceFacts({.force_dimension = libraryOf("bonemill_bridge_force_dimension"),
                                          .open_haptics = libraryOf("bonemill_bridge_touch")}));
}

const char* deviceChoices() {
    return "The hand: auto (the best that is there), simulated (a scripted hand on the emulated ARES), "
           "ares:ADDRESS:PORT (a controller that speaks docs/reference/ares_link.md), bridge:ADDRESS:PORT (a "
           "program that speaks its pose packets), ros2[:NAMESPACE] (a robot or program of ROS 2, "
           "docs/howto/ros2.md), force-dimension, touch, haply, igtl (told by OpenIGTLink), spacemouse, "
           "gamepad[:PATH], pointer (the mouse in a "
           "viewer)";
}

ChosenDevice chooseDevice(const FollowedScene& scene, const DaemonOptions& options) {
    std::string word = options.device;
    if (word == "auto") word = bestOf(foundDevices());
    if (scene.hand == HandChoice::kPointer) word = "pointer";
    ChosenDevice chosen = deviceOf(word, scene, options);
    if (!options.pedal.empty())
        chosen.device = std::make_unique<PedalledDevice>(std::move(chosen.device), options.pedal);
    return chosen;
}

}  // namespace bonemill
