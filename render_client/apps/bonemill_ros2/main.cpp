// bonemill_ros2 lets nodes of ROS 2 hear a session (docs/howto/ros2.md).
#include <spdlog/spdlog.h>

#include <chrono>
#include <iostream>
#include <optional>
#include <string>

#include "common/base/user_error.h"
#include "common/cli/command_line.h"
#include "common/dds/network_cli.h"
#include "common/log/log.h"
#include "common/process/run_program.h"
#include "common/ros/ros_domain.h"
#include "common/rt/stop_signals.h"
#include "render_client/peers/ros2_session/ros2_session.h"

namespace bonemill {
namespace {

constexpr std::chrono::milliseconds kLook{5};

struct Options {
    ros2::Ros2SessionOptions session;
    dds::NetworkOptions network;
    std::optional<double> seconds;
    std::string log_level = "info";
};

// Returns nothing after --help, which is already printed. Throws UserError.
std::optional<Options> parseOptions(int argc, char** argv) {
    Options options;
    options.session.ros = ros2::rosOptionsOfEnvironment();
    CLI::App app{"Says a session of bonemill again in the messages of ROS 2, which need not be installed."};
    app.add_option("--session", options.session.session, "Number that haptic_server was started with")
        ->capture_default_str();
    app.add_option("--domain", options.session.domain, "DDS domain of the session")
        ->check(CLI::Range(0, 230))
        ->capture_default_str();
    ros2::addRosDomainOption(app, options.session.ros);
    app.add_option("--namespace", options.session.name_space,
                   "The topics are called /NAMESPACE/measured_cp and so on")
        ->capture_default_str();
    app.add_option("--seconds", options.seconds, "End after so many s")->check(within(1e-3, kMaxSeconds));
    dds::addNetworkOptions(app, options.network);
    addLogLevelOption(app, options.log_level);
    if (!parseCommandLine(app, argc, argv, "bonemill_ros2")) return std::nullopt;
    options.session.name_space = ros2::requireNamespace(options.session.name_space);
    return options;
}

// Anyone in a domain of ROS 2 hears what is said there.
void requireClosed(const Options& options) {
    if (options.network.secure.empty() || ros2::isLocalhostOnly()) return;
    throw UserError("--secure: ROS domain " + std::to_string(options.session.ros.domain) +
                    " is not, and would leave the session readable for everybody on the network; set "
                    "ROS_LOCALHOST_ONLY=1, and no CYCLONEDDS_URI, to say it on this PC alone");
}

int serve(const Options& options, const StopSignals& stop_signals) {
    using Clock = std::chrono::steady_clock;
    ros2::Ros2Session session(options.session);
    spdlog::info("session {} is said in ROS domain {}{}, as /{}", options.session.session,
                 options.session.ros.domain, ros2::isLocalhostOnly() ? " of this PC" : "",
                 options.session.name_space);
    const auto start = Clock::now();
    while (stop_signals.await(0) == 0 &&
           (!options.seconds || Clock::now() - start < std::chrono::duration<double>(*options.seconds))) {
        session.wait(kLook);
        session.step();
    }
    spdlog::info("{} ticks were said, {} were missing", session.ticks(), session.missingTicks());
    return 0;
}

int run(int argc, char** argv) {
    const std::optional<Options> options = parseOptions(argc, argv);
    if (!options) return 0;
    setUpLog("bonemill_ros2", options->log_level);
    requireClosed(*options);
    const StopSignals stop_signals;
    dds::setNetwork(options->network, dds::NetworkPart::kViewer, options->session.session);
    return serve(*options, stop_signals);
}

}  // namespace
}  // namespace bonemill

int main(int argc, char** argv) {
    return bonemill::runProgram([&] { return bonemill::run(argc, argv); });
}
