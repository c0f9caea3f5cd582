#include <signal.h>
#include <stdlib.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "common/base/user_error.h"
#include "common/rt/clock.h"
#include "common/secrets/secrets.h"
#include "tests/bench/bench_commands.h"
#include "tests/bench/bench_output.h"
#include "tests/bench/processor_time.h"
#include "tests/support/dds_session.h"
#include "tests/support/places.h"
#include "tests/support/virtual_network.h"

namespace bonemill::bench {
namespace {

using namespace std::chrono_literals;
using test::Host;
using test::Process;
using test::VirtualNetwork;

constexpr char kToken[] = "guests of the bench";
constexpr uint16_t kPort = 8443;
constexpr auto kAloneTime = 4s;  // over which processor time is taken

struct GuestsOptions {
    std::string scene = test::sourceDir() + "/deploy/scenes/tooth_cavity.textproto", json;
    int guests = 1, stalled = 0;
    test::LineQuality line;
    int mill_s = 10, cut_s = 0, patience_s = 180;
};

bool isGood(const test::LineQuality& line) {
    return line.rate_kbit_per_s == 0 && line.delay_ms == 0 && line.loss_per_mille == 0;
}

// The server, the hand and the gateway are on one PC, the guests on another.
class GuestSession {
  public:
    explicit GuestSession(const GuestsOptions& o)
        : options_(o),
          lab_(network_.addHost()),
          far_(isGood(o.line) ? network_.addHost() : network_.addHost(o.line)) {
        setenv("XDG_CONFIG_HOME", (folder_ / "config").c_str(), 1);
        test::writeFile(folder_ / "guests", "invitations { name: \"Guest\" role: VIEWER token_sha256: \"" +
                                                sha256Hex(kToken) + "\" people: 64 }\n");
        server_ = lab_.start(words({"haptic_server", "--scene", o.scene, "--report", report()}));
        gateway_ = lab_.start(words({"render_client", "--serve", lab_.address() + ':' + std::to_string(kPort),
                                     "--guests", folder_ / "guests"}));
        // The gateway prints a page's warning, its address, and its fingerprint.
        waitUntil([&] { return fingerprint().size() == 64; }, "the gateway");
        std::this_thread::sleep_for(3s);  // it has the model
    }

    void startGuests() {
        for (int n = 0; n < options_.guests; ++n)
            guests_.push_back(far_.start({test::helperDir() + "/guest_reader", lab_.address(),
                                          std::to_string(kPort), fingerprint(), kToken}));
        for (const auto& guest : guests_)
            waitUntil([&] { return said(*guest).contains("whole_s"); }, "a guest: " + guest->errSoFar());
    }
    void startMilling() {
        daemon_ = lab_.start(words({"device_daemon", "--device", "simulated", "--wait-seconds", "60"}));
    }
    void stopMilling() {
        daemon_->signal(SIGTERM);
        daemon_->wait();
        std::this_thread::sleep_for(2s);
    }
    void cutFor(std::chrono::seconds time) {
        lab_.unplug();
        std::this_thread::sleep_for(time);
        lab_.plugIn();
    }
    // Seconds until every guest has what the first guest's server counts.
    double untilAllAreWhole() {
        const int64_t start_ns = monotonicNowNs();
        for (const auto& guest : guests_)
            waitUntil(
                [&] {
                    return !said(*guest)["is_cut"].get<bool>() && said(*guest)["is_complete"].get<bool>();
                },
                "a guest after the cut");
        return secondsOfNs(monotonicNowNs() - start_ns);
    }
    nlohmann::json finish() {
        server_->signal(SIGTERM);
        server_->wait();
        return nlohmann::json::parse(test::readFile(report()));
    }

    static nlohmann::json said(const Process& guest) {
        const std::string text = guest.outSoFar();
        const size_t end = text.rfind('\n');
        if (end == std::string::npos) return nlohmann::json::object();
        const size_t before = end == 0 ? std::string::npos : text.rfind('\n', end - 1);
        const size_t begin = before == std::string::npos ? 0 : before + 1;
        return nlohmann::json::parse(text.substr(begin, end - begin));
    }
    const std::vector<std::unique_ptr<Process>>& guests() const { return guests_; }
    const Process& server() const { return *server_; }
    const Process& gateway() const { return *gateway_; }
    uint64_t sentBytes() const { return far_.traffic().received_bytes; }

  private:
    std::string report() const { return folder_ / "report.json"; }
    std::vector<std::string> words(std::vector<std::string> words) const {
        words.insert(words.end(), {"--session", std::to_string(testSession())});
        return words;
    }
    std::string fingerprint() const {
        const std::string text = gateway_->outSoFar(), before = "(SHA-256): ";
        const size_t at = text.find(before);
        if (at == std::string::npos) return "";
        return text.substr(at + before.size(), text.find('\n', at) - at - before.size());
    }
    template <class Condition>
    void waitUntil(Condition&& condition, const std::string& what) const {
        const int64_t end_ns = monotonicNowNs() + options_.patience_s * kNsPerSecond;
        while (!condition()) {
            if (!server_->isRunning() || !gateway_->isRunning() || monotonicNowNs() > end_ns)
                throw UserError("waited in vain for " + what + "; server: " + server_->errSoFar() +
                                "gateway: " + gateway_->errSoFar());
            std::this_thread::sleep_for(20ms);
        }
    }

    const GuestsOptions& options_;
    test::TemporaryFolder folder_;
    VirtualNetwork network_;
    Host lab_, far_;
    std::unique_ptr<Process> server_, gateway_, daemon_;
    std::vector<std::unique_ptr<Process>> guests_;
};

nlohmann::json spread(const GuestSession& session, const char* key) {
    std::vector<double> values;
    for (const auto& guest : session.guests()) values.push_back(GuestSession::said(*guest)[key]);
    std::sort(values.begin(), values.end());
    return {{"p50", values[values.size() / 2]}, {"max", values.back()}};
}

// The guest whose cuts took longest.
nlohmann::json worstLag(const GuestSession& session) {
    nlohmann::json worst;
    for (const auto& guest : session.guests()) {
        const nlohmann::json lag = GuestSession::said(*guest)["cut_to_viewer_ms"];
        if (worst.is_null() || lag["p99"] > worst["p99"]) worst = lag;
    }
    return worst;
}

bool allAgree(const GuestSession& session, const nlohmann::json& report) {
    const uint64_t digest = std::stoull(report["published_digest"].get<std::string>(), nullptr, 16);
    return std::ranges::all_of(session.guests(), [&](const auto& guest) {
        return GuestSession::said(*guest)["digest"] == digest &&
               GuestSession::said(*guest)["nodes"] == report["published_nodes"];
    });
}

nlohmann::json measure(const GuestsOptions& o) {
    nlohmann::json json;
    GuestSession session(o);
    json["gateway_bytes_alone"] = residentBytesOf(test::workOf(session.gateway()));
    json["gateway_share_alone"] = shareOfACore(test::workOf(session.gateway()), kAloneTime);
    const uint64_t sent_before = session.sentBytes();
    session.startGuests();
    json["bytes_per_guest_until_whole"] = double(session.sentBytes() - sent_before) / o.guests;
    for (const char* key : {"connected_s", "first_s", "whole_s"}) json[key] = spread(session, key);
    json["gateway_bytes_with_guests"] = residentBytesOf(test::workOf(session.gateway()));

    for (int n = 0; n < o.stalled; ++n) session.guests()[size_t(n)]->signal(SIGSTOP);
    session.startMilling();
    const uint64_t sent = session.sentBytes();
    const double server = processorSeconds(session.server().pid()),
                 gateway = processorSeconds(test::workOf(session.gateway()));
    std::this_thread::sleep_for(std::chrono::seconds(o.mill_s));
    json["server_share"] = (processorSeconds(session.server().pid()) - server) / o.mill_s;
    json["gateway_share"] = (processorSeconds(test::workOf(session.gateway())) - gateway) / o.mill_s;
    json["kbit_per_s_per_guest"] = 8e-3 * double(session.sentBytes() - sent) / o.mill_s / o.guests;
    json["cut_to_viewer_ms"] = worstLag(session);
    json["gateway_bytes_after_milling"] = residentBytesOf(test::workOf(session.gateway()));
    for (int n = 0; n < o.stalled; ++n) session.guests()[size_t(n)]->signal(SIGCONT);

    if (o.cut_s > 0) {
        session.cutFor(std::chrono::seconds(o.cut_s));
        json["whole_again_s"] = session.untilAllAreWhole();
    }
    session.stopMilling();
    session.untilAllAreWhole();
    std::this_thread::sleep_for(1s);  // they have said so
    const nlohmann::json report = session.finish();
    json["removed_mm3"] = report["removed_mm3"];
    json["states_agree"] = allAgree(session, report);
    return json;
}

void run(const GuestsOptions& o) {
    std::string missing = VirtualNetwork::enter();
    if (missing.empty()) missing = VirtualNetwork::missingForLines();
    if (!missing.empty()) throw UserError("no virtual network here: " + missing);
    nlohmann::json json = measure(o);
    for (const auto& [key, value] : json.items())
        std::printf("%-28s %s\n", key.c_str(), value.dump().c_str());
    writeJson(o.json, json);
}

}  // namespace

void addGuestsCommand(CLI::App& app) {
    auto o = std::make_shared<GuestsOptions>();
    CLI::App* command =
        app.add_subcommand("guests", "a session that mills, and guests of a gateway on another PC");
    command->add_option("--scene", o->scene, "of the session");
    command->add_option("--guests", o->guests, "so many at once")->check(CLI::Range(1, 64));
    command->add_option("--stalled", o->stalled, "so many of them are stopped while it mills")
        ->check(CLI::Range(0, 64));
    command->add_option("--rate-kbit-per-s", o->line.rate_kbit_per_s, "of the guests' line; 0: no limit");
    command->add_option("--delay-ms", o->line.delay_ms, "each way");
    command->add_option("--loss-per-mille", o->line.loss_per_mille, "frames, each way");
    command->add_option("--mill-s", o->mill_s, "it mills so long before what is asked of it")
        ->check(CLI::Range(1, 1000));
    command->add_option("--cut-s", o->cut_s, "then the line is cut so long, while it mills on");
    command->add_option("--patience-s", o->patience_s, "to wait for guests to be whole");
    addJsonOption(*command, o->json);
    command->callback([o] { run(*o); });
}

}  // namespace bonemill::bench
