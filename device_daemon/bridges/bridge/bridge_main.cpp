#include "device_daemon/bridges/bridge/bridge_main.h"

#include <locale.h>
#include <poll.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>

#include "common/base/user_error.h"
#include "common/process/end_with_parent.h"
#include "common/rt/clock.h"
#include "device_daemon/bridges/bridge/bridge_link.h"
#include "device_daemon/bridges/bridge/self_test.h"
#include "device_daemon/bridges/bridge/way_out.h"

namespace bonemill::bridge {
namespace {

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

int runProgram(int argc, char** argv, const BridgeProgram& program) {
    const auto options = parseBridgeOptions(argc, argv, program.about, program.add_options);
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
    int result = 1;
    try {
        result = runProgram(argc, argv, program);
    } catch (const UserError& error) {
        say(std::string("error: ") + error.what());
        result = kUserErrorExitCode;
    } catch (const std::exception& error) {
        say(std::string("error: ") + error.what());
    }
    _exit(result);  // what vendors' libraries do at exit() is not known to be harmless
}

}  // namespace bonemill::bridge
