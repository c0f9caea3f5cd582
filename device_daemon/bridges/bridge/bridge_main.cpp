#include "device_daemon/bridges/bridge/bridge_main.h"

#include <locale.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <iostream>
#include <string_view>
#include <thread>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/cli/command_line.h"
#include "common/process/run_program.h"
#include "common/process/standard_output.h"
#include "common/rt/clock.h"
#include "common/rt/stop_signals.h"
#include "device_daemon/bridges/bridge/bridge_link.h"
#include "device_daemon/bridges/bridge/self_test.h"

namespace bonemill::bridge {
namespace {

void addOptions(CLI::App& app, BridgeOptions& options) {
    app.add_option("--port", options.port, "UDP port that device_daemon speaks to; 0 takes any free one")
        ->capture_default_str();
    app.add_option("--address", options.address, "Address of this PC to listen on")->capture_default_str();
    app.add_option("--host-port", options.host_port,
                   "Listen to nobody but this port of this PC (0: to any host)");
    app.add_option("--library", options.library, "The vendor's library, if it is not where it is searched");
    app.add_option("--device", options.device, "Number or name of the arm; default: the first");
    app.add_option("--max-force-n", options.max_force, "Give no more than this; default: what the arm can")
        ->check(within(1e-3, 1e3));
    app.add_option("--handle-mass-kg", options.mass, "What moves with the handle weighs this")
        ->check(within(1e-3, 10));
    app.add_option("--handle-damping-ns-per-m", options.damping, "The arm's viscous damping")
        ->check(within(0, 100));
    app.add_option("--delay-ms", options.delay_ms, "From the reading of the pose until its force begins")
        ->check(within(0, 50));
    app.add_option("--encoder-step-um", options.encoder_step_um, "Positions come in steps of this")
        ->check(within(1e-3, 1e3));
    app.add_flag("--probe", options.probe,
                 "Load the library, open the arm, say what there is and leave; gives no force");
    CLI::Option* self_test = app.add_flag("--self-test", options.self_test,
                                          "Measure rate and jitter of the arm, without device_daemon");
    app.add_flag("--ramp", options.ramp, "With --self-test: push up with 0.5 N and back, after you typed yes")
        ->needs(self_test);
    app.add_option("--seconds", options.seconds, "How long the self-test lasts")
        ->check(within(0.1, 3600))
        ->needs(self_test)
        ->capture_default_str();
    addRealtimeOptions(app, "the arm's loop", options.is_strict_realtime, options.core);
    addParentOption(app, options.parent);
}

void tellOfHandle(const BridgeOptions& options, HandleDynamics& handle) noexcept {
    handle.mass = options.mass.value_or(handle.mass);
    handle.damping = options.damping.value_or(handle.damping);
    if (options.delay_ms) handle.delay = *options.delay_ms * kMillisecond;
    if (options.encoder_step_um) handle.encoder_step = *options.encoder_step_um * kMicrometre;
}

// Returns nothing after --help, which is already printed. Throws UserError.
std::optional<BridgeOptions> parseOptions(int argc, char** argv, const BridgeProgram& program) {
    BridgeOptions options;
    CLI::App app{program.about};
    addOptions(app, options);
    if (program.add_options) program.add_options(app);
    if (!parseCommandLine(app, argc, argv, std::filesystem::path(argv[0]).filename())) return std::nullopt;
    return options;
}

// The process ends with it when time was up: the kernel closes what the library has open, and the arm's own
// watchdog takes the force away.
constexpr int kStuckExitCode = 3;
constexpr int64_t kTimeToLeaveNs = 2 * kNsPerSecond;
constexpr int64_t kLookEveryNs = 20 * kNsPerMillisecond;

[[noreturn]] void leaveLibraryBehind() noexcept {
    constexpr std::string_view kText = "error: the vendor's library does not return; leaving without it\n";
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kText.data(), kText.size());
    _exit(kStuckExitCode);
}

// Watches over the end of a bridge: it takes the signals that ask for it, and ends the process when a
// vendor's library does not let go in time.
//
// It has a thread of its own, so that it works while a vendor's call never returns. Make it before any other
// thread and before a library is loaded: all threads inherit that the signals are its own.
class WayOut {
  public:
    WayOut() : thread_([this] { watch(); }) {}
    ~WayOut() {
        is_over_ = true;
        thread_.join();
    }

    // SIGINT, SIGTERM or SIGHUP has come; the process has kTimeToLeaveNs left from then on.
    bool isRequested() const noexcept { return is_requested_; }
    // The process is about to end for another reason, and has as much time.
    void begin() noexcept {
        int64_t none = 0;
        deadline_ns_.compare_exchange_strong(none, monotonicNowNs() + kTimeToLeaveNs);
    }

  private:
    void watch() noexcept {
        while (!is_over_) {
            if (stop_signals_.await(kLookEveryNs)) {
                is_requested_ = true;
                begin();
            }
            if (deadline_ns_ != 0 && monotonicNowNs() > deadline_ns_) leaveLibraryBehind();
        }
    }

    StopSignals stop_signals_;
    std::atomic<bool> is_requested_{false};
    std::atomic<int64_t> deadline_ns_{0};  // 0: none
    std::atomic<bool> is_over_{false};
    std::thread thread_;
};

constexpr int64_t kHangNs = 2 * kNsPerSecond;
constexpr int64_t kFarewellNs = 200 * kNsPerMillisecond;
constexpr useconds_t kLookEveryUs = 20'000;

// Vendors' libraries read their files with the decimal point of the user's locale, and choose it themselves.
void keepPointInNumbers() {
    setenv("LC_ALL", "C", 1);
    setlocale(LC_ALL, "C");
}

void say(const std::string& line) {
    std::cerr << line << std::endl;
}

void print(const std::string& line) {
    std::cout << line << std::endl;
}

std::vector<std::string> linesOf(const ArmDescription& arm) {
    const auto number = [](double value) {
        std::string text = std::to_string(value);
        return text.substr(0, text.find('.') + 3);
    };
    return {"arm: " + arm.name + ", serial " + std::to_string(arm.serial),
            "force: up to " + number(arm.max_force) + " N",
            arm.max_torque > 0 ? "torque: up to " + number(arm.max_torque) + " N·m" : "torque: none",
            std::string("orientation: ") + (arm.has_orientation ? "sensed" : "not sensed"),
            "workspace radius: " + number(arm.workspace_radius * kPerMillimetre) + " mm"};
}

class BridgeRun {
  public:
    BridgeRun(Arm& arm, const BridgeOptions& options, WayOut& way_out)
        : arm_(arm), options_(options), way_out_(way_out) {}

    int run();

  private:
    int runLink();
    int serve(const BridgeLink& link);
    void sayFarewell(BridgeLink& link);
    int runSelfTest();
    bool isConfirmed();
    bool isHung(int64_t last_step_ns) const;
    void start(ArmPeriod& period);
    void stop();

    Arm& arm_;
    const BridgeOptions& options_;
    WayOut& way_out_;
    ArmDescription description_;
    int64_t start_ns_ = 0;
};

int BridgeRun::run() {
    const Tell tell = options_.probe ? print : say;
    description_ = arm_.open(tell);
    if (options_.max_force) description_.max_force = std::min(description_.max_force, *options_.max_force);
    tellOfHandle(options_, description_.handle);
    for (const std::string& line : linesOf(description_)) tell(line);
    start_ns_ = monotonicNowNs();
    if (!options_.probe) return options_.self_test ? runSelfTest() : runLink();
    stop();
    return 0;
}

int BridgeRun::runLink() {
    BridgeLink link(description_, wire::endpointOf(options_.address, options_.port),
                    wire::hereAt(options_.host_port));
    print("listening on " + wire::textOf(link.local()));
    start(link);
    const int result = serve(link);
    sayFarewell(link);
    stop();
    forgiveUnprinted();
    return result;
}

int BridgeRun::serve(const BridgeLink& link) {
    while (!way_out_.isRequested()) {
        usleep(kLookEveryUs);
        if (link.isArmLost()) {
            say("error: device: the arm no longer answers (the vendor's number " +
                std::to_string(link.faultCode()) +
                "). Is it unplugged or switched off? Start the bridge again when it is back.");
            return 1;
        }
        if (isHung(link.lastStepNs())) {
            say("error: the vendor's library has not returned for 2 s");
            return 1;
        }
    }
    return 0;
}

bool BridgeRun::isHung(int64_t last_step_ns) const {
    return monotonicNowNs() - std::max(start_ns_, last_step_ns) > kHangNs;
}

void BridgeRun::sayFarewell(BridgeLink& link) {
    link.leave();
    const int64_t deadline_ns = monotonicNowNs() + kFarewellNs;
    while (!link.hasLeft() && monotonicNowNs() < deadline_ns) usleep(1000);
}

bool BridgeRun::isConfirmed() {
    print("The arm will push up with 0.5 N and back. Hold the handle, and type yes:");
    pollfd input{STDIN_FILENO, POLLIN, 0};
    while (poll(&input, 1, 20) == 0)
        if (way_out_.isRequested()) return false;
    std::string answer;
    std::getline(std::cin, answer);
    return answer == "yes";
}

int BridgeRun::runSelfTest() {
    if (options_.ramp && !isConfirmed()) throw UserError("--ramp was not confirmed: nothing was done");
    SelfTest test(description_, options_.seconds, options_.ramp);
    start_ns_ = monotonicNowNs();
    start(test);
    while (!test.hasEnded() && !way_out_.isRequested() && !isHung(test.lastStepNs())) usleep(kLookEveryUs);
    test.leave();
    usleep(kLookEveryUs + useconds_t(ForceGate::kFadeTime * kPerMicro));
    stop();
    const std::vector<std::string> lines = test.lines();
    for (const std::string& line : lines) print(line);
    return lines.front() == "passed" ? 0 : 1;
}

void BridgeRun::start(ArmPeriod& period) {
    try {
        arm_.start(period);
    } catch (...) {
        stop();  // before `period` goes
        throw;
    }
}

void BridgeRun::stop() {
    way_out_.begin();
    arm_.stop();
}

int bridgeArm(int argc, char** argv, const BridgeProgram& program) {
    const auto options = parseOptions(argc, argv, program);
    if (!options) return 0;
    if (options->parent) endWithParent(*options->parent);
    WayOut way_out;
    const std::unique_ptr<Arm> arm = program.make_arm(*options);
    try {
        return BridgeRun(*arm, *options, way_out).run();
    } catch (...) {
        way_out.begin();
        arm->stop();
        throw;
    }
}

}  // namespace

int runBridge(int argc, char** argv, const BridgeProgram& program) {
    keepPointInNumbers();
    const int result = bonemill::runProgram([&] { return bridgeArm(argc, argv, program); });
    _exit(result);  // what vendors' libraries do at exit() is not known to be harmless
}

}  // namespace bonemill::bridge
