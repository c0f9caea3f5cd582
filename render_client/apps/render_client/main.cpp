// render_client shows a session (docs/reference/viewer.md), or does here what needs no picture.
#include <spdlog/spdlog.h>

#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <thread>

#include "common/base/user_error.h"
#include "common/files/config_folder.h"
#include "common/files/whole_file.h"
#include "common/log/log.h"
#include "common/process/run_program.h"
#include "common/process/standard_output.h"
#include "common/process/supervisor.h"
#include "common/rt/realtime.h"
#include "common/secrets/secrets.h"
#include "common/tcp/listen.h"
#include "render_client/apps/render_client/scene_feed.h"
#include "render_client/apps/render_client/unattended_viewer.h"
#include "render_client/apps/render_client/window_viewer.h"
#include "render_client/language/language.h"
#include "render_client/link/subscribe/command_words.h"
#include "render_client/link/subscribe/session_list.h"
#include "render_client/viewer_options/viewer_options.h"
#include "render_client/viewer_options/web_options.h"
#include "render_client/web/connect/gateway_session.h"
#include "render_client/web/gateway/gateway_server.h"
#include "render_client/web/relay/relay.h"

namespace bonemill {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kGatewayPatience{10}, kListPatience{2};
constexpr std::chrono::milliseconds kSlice{20};  // how often what is waited for is looked after

// The token itself is kept nowhere.
std::filesystem::path ticketFile(const std::string& token) {
    return configFolder() / "tickets" / sha256Hex(token);
}

std::string keptTicket(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::string ticket;
    std::getline(stream, ticket);
    return ticket;
}

void keepTicket(const std::filesystem::path& file, const std::string& ticket) {
    try {
        writePrivateFile(file, ticket);
    } catch (const std::exception& error) {
        spdlog::warn("{}; the next run needs another invitation", error.what());
    }
}

std::shared_ptr<connect::GatewaySession> sessionOf(const ConnectOptions& options, const std::string& ticket) {
    if (!ticket.empty()) {
        try {
            return std::make_shared<connect::GatewaySession>(options.target, ticket, kGatewayPatience);
        } catch (const UserError&) {
            // The gateway has forgotten it, or does not answer: the token tells.
        }
    }
    return std::make_shared<connect::GatewaySession>(options.target, options.token, kGatewayPatience);
}

// render_client --connect: the viewer becomes a gateway's guest. Comes in with the ticket of an earlier run,
// or else with the token, and keeps the ticket in the user's configuration. From then on the options have the
// session, and name and role that the gateway's list gives. Throws UserError.
void connectToGateway(ClientOptions& options) {
    ConnectOptions& wish = *options.connect;
    const std::filesystem::path file = ticketFile(wish.token);
    const auto session = sessionOf(wish, keptTicket(file));
    keepTicket(file, session->welcome().ticket());
    wish.token.clear();
    options.subscriber.name = session->welcome().name();
    options.subscriber.role = session->welcome().role();
    options.subscriber.remote = session;
}

// render_client --list: which sessions are there? Listens for some seconds and prints one line per session of
// the domain. Returns the exit code: 1 where there is none, which is said. Throws UserError when the DDS
// domain cannot be joined.
int runListSessions(const ClientOptions& options) {
    SessionList list(options.subscriber.domain);
    for (const auto end = Clock::now() + kListPatience; Clock::now() < end && !stopRequested();) {
        std::this_thread::sleep_for(kSlice);
        list.poll();
    }
    const std::vector<ListedSession> sessions = list.sessions();
    for (const ListedSession& session : sessions) std::cout << sessionText(session) << '\n';
    if (sessions.empty())
        std::cerr << "no session in domain " << options.subscriber.domain
                  << "; on other PCs they are found with --profile lab or classroom" << std::endl;
    return sessions.empty() ? 1 : 0;
}

// render_client --relay and --serve: a relay or a gateway instead of a viewer. They say where they can be
// reached, and serve until a stop signal, supervised. Return the exit code. Throw UserError.
//
// Both listen before their work begins: so a place that cannot be had is said at once, and who comes while
// the work is started again waits.
int runRelay(const ClientOptions& options) {
    Descriptor listener = listenOn(options.relay->address, options.relay->port);
    const std::string place = textOf(NetworkPlace{options.relay->address, portOf(listener.get())});
    return supervise("the relay", stopRequested, [&](const Heartbeat& heart, bool is_first) {
        Relay relay(*options.relay, {}, std::move(listener));
        if (is_first) std::cout << "relay for a gateway with --via: " << place << std::endl;
        relay.run([&heart] {
            heart.beat();
            return stopRequested();
        });
        const Relay::Counts counts = relay.counts();
        spdlog::info("the relay ends: it passed on {} bytes and turned {} lines away", counts.bytes,
                     counts.refused);
        forgiveUnprinted();
        return 0;
    });
}

void introduce(const gateway::GatewayServer& server, const gateway::GatewayOptions& options) {
    std::cout << "gateway of session " << options.session << ": https://"
              << textOf(NetworkPlace{options.address, server.port()}) << '\n';
    if (options.via)
        std::cout << "through the relay, once it is reached: https://"
                  << textOf(NetworkPlace{options.via->host, options.via->port}) << '\n';
    if (server.certificate().is_self_made)
        std::cout << "certificate of its own making, which browsers ask about; fingerprint (SHA-256): "
                  << server.certificate().fingerprint << '\n';
    if (!server.hasPage()) std::cout << "the page was not built: only viewers with --connect can come\n";
    std::cout << std::flush;
}

int runGateway(const ClientOptions& options) {
    Descriptor listener = listenOn(options.serve->address, options.serve->port);
    return supervise("the gateway", stopRequested, [&](const Heartbeat& heart, bool is_first) {
        gateway::GatewayServer server(*options.serve, std::move(listener));
        if (is_first) introduce(server, *options.serve);
        server.serveUntil([&heart] {
            heart.beat();
            return stopRequested();
        });
        forgiveUnprinted();
        return 0;
    });
}

// Returns true when `condition` held in time, false after `end` or a stop signal.
template <class Condition>
bool pollUntil(SceneSubscriber& subscriber, Clock::time_point end, Condition&& condition) {
    while (!stopRequested() && Clock::now() < end) {
        subscriber.poll();
        if (condition()) return true;
        subscriber.waitForData(kSlice);
    }
    return false;
}

// render_client --command, for scripts: one line on stdout. Waits for the server, asks it and prints its
// answer. Returns the program's exit code: 0 if the server did it, 1 if it refused or did not answer, or a
// stop signal came first. Throws UserError (DDS domain, a tool or checkpoint that the session does not have),
// and std::runtime_error when no server came in time.
int runSendCommand(const ClientOptions& options) {
    const CommandOptions& wish = *options.command;
    SceneSubscriber subscriber(options.subscriber);
    // A server takes commands as soon as it shows a status.
    const auto is_ready = [&] {
        return subscriber.hasServer() && subscriber.status() && subscriber.sceneInfo();
    };
    if (!pollUntil(subscriber, Clock::now() + wish.timeout, is_ready)) {
        if (stopRequested()) return 1;
        throw std::runtime_error("no server within " + std::to_string(wish.timeout.count()) +
                                 " s: " + serverQuestion(options.subscriber));
    }
    subscriber.sendCommand(commandOf(wish.text, *subscriber.sceneInfo(), *subscriber.status()));
    std::vector<CommandOutcome> outcomes;
    // The outbox itself gives up in time.
    pollUntil(subscriber, Clock::time_point::max(),
              [&] { return !(outcomes = subscriber.takeOutcomes()).empty(); });
    if (outcomes.empty()) return 1;
    std::cout << outcomeText(outcomes.front());
    if (outcomes.front().command.has_replay() && outcomes.front().isDone() &&
        !subscriber.status()->replay().event().empty())
        std::cout << ": " << subscriber.status()->replay().event();
    std::cout << std::endl;
    return outcomes.front().isDone() ? 0 : 1;
}

// Mesa crashes where it gets no memory to draw and to compile shaders in.
constexpr size_t kPictureBytes = size_t(1) << 30;

int view(int argc, char** argv) {
    auto options = parseOptions(argc, argv);
    hideTokens(argc, argv);
    if (!options) return 0;
    setUpLog("render_client", options->log_level);
    speak(options->language);
    catchStopSignals();
    if (options->relay) return runRelay(*options);
    const bool is_of_one = !options->lists_sessions && !options->chooses_session;
    dds::setNetwork(options->network, dds::NetworkPart::kViewer,
                    is_of_one ? std::optional(options->subscriber.session) : std::nullopt);
    if (options->connect) connectToGateway(*options);
    if (options->lists_sessions) return runListSessions(*options);
    if (options->serve) return runGateway(*options);
    if (options->command) return runSendCommand(*options);
    requireMemory(kPictureBytes, "the pictures");
    keepFreedHeap();  // every picture takes and frees some MB
    if (options->measure) {
        runMeasurement(*options);
    } else if (options->offscreen && options->offscreen->video) {
        runVideo(*options);
    } else if (options->offscreen) {
        runOffscreen(*options);
    } else {
        runWindow(*options);
        forgiveUnprinted();
    }
    return 0;
}

}  // namespace
}  // namespace bonemill

int main(int argc, char** argv) {
    return bonemill::runProgram([&] { return bonemill::view(argc, argv); });
}
