// bonemill_igtl shows a session to 3D Slicer and to whatever else speaks OpenIGTLink (docs/howto/slicer.md).
#include <malloc.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <array>
#include <iostream>

#include "common/base/user_error.h"
#include "common/cli/command_line.h"
#include "common/dds/network_cli.h"
#include "common/log/log.h"
#include "common/process/run_program.h"
#include "common/process/standard_output.h"
#include "common/rt/stop_signals.h"
#include "common/secrets/secrets.h"
#include "common/tcp/listen.h"
#include "render_client/peers/igtl_session/igtl_session.h"

namespace bonemill {
namespace {

using topics::Viewer;

constexpr std::array<std::pair<const char*, Viewer::Role>, 4> kRoles{{{"viewer", Viewer::VIEWER},
                                                                      {"operator", Viewer::OPERATOR},
                                                                      {"instructor", Viewer::INSTRUCTOR},
                                                                      {"examiner", Viewer::EXAMINER}}};

struct Options {
    igtl::IgtlOptions igtl;
    dds::NetworkOptions network;
    std::string role = "viewer";
    std::string secret_file;
    std::string log_level = "info";
    std::optional<int> parent;
};

void addOptions(CLI::App& app, Options& options) {
    SubscriberOptions& subscriber = options.igtl.subscriber;
    subscriber.name = "OpenIGTLink";
    app.add_option("--port", options.igtl.port, "TCP port that peers come to; 0 takes any free one")
        ->capture_default_str();
    app.add_option("--address", options.igtl.address,
                   "Address of this PC to listen on; 0.0.0.0 for all. What is sent there is not encrypted")
        ->capture_default_str();
    app.add_option("--domain", subscriber.domain, "DDS domain of the server")
        ->check(CLI::Range(uint32_t{0}, dds::kMaxDomain))
        ->capture_default_str();
    app.add_option("--session", subscriber.session, "Number that haptic_server was started with")
        ->capture_default_str();
    dds::addNetworkOptions(app, options.network);
    app.add_option("--name", subscriber.name, "What the others read in their list of viewers")
        ->capture_default_str();
    app.add_option("--secret-file", options.secret_file,
                   "What a peer of this PC says before it may order, at least 32 letters, readable for "
                   "nobody else")
        ->type_name("FILE");
    std::vector<std::string> roles;
    for (const auto& [name, role] : kRoles) roles.emplace_back(name);
    app.add_option(
           "--role", options.role,
           "In which role peers order; a viewer orders nothing (with --secure what the identity says)")
        ->check(CLI::IsMember(roles))
        ->capture_default_str();
    app.add_option("--bone-mbit-per-s", options.igtl.bone_mbit_per_s,
                   "The bone takes so much of each peer's line, at most")
        ->check(within(0.1, 10000))
        ->capture_default_str();
    addParentOption(app, options.parent);
    addLogLevelOption(app, options.log_level);
}

// With --secure the server asks the certificate who this is; what is said here is the same.
void takeOver(const Identity& identity, Options& options) {
    SubscriberOptions& subscriber = options.igtl.subscriber;
    subscriber.name = identity.name;
    if (identity.session) subscriber.session = *identity.session;
    options.role = identity.role == "observer" ? "viewer" : identity.role;
    if (!isLoopback(options.igtl.address))
        throw UserError(
            "--address " + options.igtl.address +
            ": a session with --secure would leave this PC readable for everybody; leave --address out, "
            "and let others come by ssh -L " +
            std::to_string(options.igtl.port) + ":127.0.0.1:" + std::to_string(options.igtl.port));
}

void finish(Options& options) {
    if (const auto identity = dds::identityOf(options.network)) takeOver(*identity, options);
    for (const auto& [name, role] : kRoles)
        if (options.role == name) options.igtl.subscriber.role = role;
    if (!options.secret_file.empty()) options.igtl.secret = readSecret(options.secret_file, "bonemill_igtl");
    const bool orders = options.igtl.subscriber.role != Viewer::VIEWER;
    if (orders && options.igtl.secret.empty() && options.network.secure.empty())
        throw UserError("--role " + options.role +
                        ": whoever reaches the port would order in it; give --secret-file, too");
    if (!orders && !options.igtl.secret.empty())
        throw UserError(
            "--secret-file: a viewer orders nothing; give --role operator, instructor or examiner, too");
}

// An image of the scan takes and frees hundreds of MB: they are given back.
void giveFreedHeapBack() {
    mallopt(M_MMAP_THRESHOLD, 1 << 20);
}

int serve(int argc, char** argv) {
    Options options;
    CLI::App app{
        "Shows a session to 3D Slicer and to other peers that speak OpenIGTLink (docs/howto/slicer.md)."};
    addOptions(app, options);
    if (!parseCommandLine(app, argc, argv, "bonemill_igtl")) return 0;
    setUpLog("bonemill_igtl", options.log_level);
    finish(options);
    if (options.parent) endWithParent(*options.parent);
    giveFreedHeapBack();
    const StopSignals stop;
    dds::setNetwork(options.network, dds::NetworkPart::kViewer, options.igtl.subscriber.session);
    igtl::IgtlSession session(options.igtl);
    std::cout << "listening on " << options.igtl.address << ":" << session.port() << std::endl;
    if (!isLoopback(options.igtl.address))
        spdlog::warn("what is sent to {} is not encrypted: whoever reaches it sees the session",
                     options.igtl.address);
    while (stop.await(0) == 0) session.step();
    forgiveUnprinted();
    return 0;
}

}  // namespace
}  // namespace bonemill

int main(int argc, char** argv) {
    return bonemill::runProgram([&] { return bonemill::serve(argc, argv); });
}
