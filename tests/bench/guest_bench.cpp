// Guests of a gateway, as many as are asked for: do all come in and get the whole model, what is each sent,
// and what does that cost the programs on the way (docs/howto/gateway.md)? They take what comes as a page
// does, and draw nothing.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <iostream>
#include <memory>
#include <thread>
#include <unordered_set>
#include <vector>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/cli/command_line.h"
#include "common/mesh_codec/mesh_codec.h"
#include "common/process/run_program.h"
#include "common/tcp/listen.h"
#include "common/web_socket/web_socket_client.h"
#include "proto/gateway.pb.h"
#include "render_client/link/subscribe/remote_session.h"
#include "tests/bench/bench_output.h"
#include "tests/bench/processor_time.h"

namespace bonemill::bench {
namespace {

using GuestClock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;
constexpr std::chrono::milliseconds kGuestRound{5}, kToCome{5000};
constexpr std::chrono::seconds kAnnounceEvery{1};
constexpr double kKib = 1024, kBitsOfByte = 8;

struct BenchWish {
    WebTarget target{.host = "127.0.0.1", .port = 8443, .fingerprint = {}};
    std::string tokens;
    uint32_t guests = 1, seconds = 10, patience_s = 120;
    std::vector<int> pids;
};

class BenchGuest {
  public:
    BenchGuest(const WebTarget& target, const std::string& token)
        : socket_(target, {.path = "/session", .protocol = "bonemill.v1"}, kToCome) {
        gateway::FromGuest frame;
        frame.mutable_hello()->set_token(token);
        frame.mutable_hello()->set_version(gateway::kProtocolVersion);
        socket_.send(frame.SerializeAsString());
        socket_.move();
    }

    void step(GuestClock::time_point now) {
        socket_.move();
        std::string bytes;
        const uint64_t before = received_;
        while (socket_.receive(bytes)) take(bytes);
        gateway::FromGuest answer;
        if (received_ != before) {
            answer.mutable_received()->set_bytes(received_);
            socket_.send(answer.SerializeAsString());
        }
        if (is_in_ && now >= announce_due_) {
            announce_due_ = now + kAnnounceEvery;
            answer.mutable_announce()->set_frame_rate_hz(60);
            socket_.send(answer.SerializeAsString());
        }
        socket_.move();
    }
    bool isIn() const { return is_in_; }
    bool isComplete() const { return wants_nodes_ > 0 && nodes_.size() == wants_nodes_; }
    bool isOut() const { return is_refused_ || socket_.hasEnded(); }
    uint64_t received() const { return received_; }
    // Payloads of nodes, as DDS has them; and the frames that they came in, without what else is in these.
    uint64_t nodeBytes() const { return node_bytes_; }
    uint64_t nodeFrameBytes() const { return node_frame_bytes_; }
    uint64_t triangles() const { return triangles_; }
    uint64_t toolBytes() const { return tool_bytes_; }
    uint64_t frames() const { return frames_; }

  private:
    void take(const std::string& bytes) {
        const uint64_t before = node_bytes_;
        received_ += bytes.size();
        ++frames_;
        gateway::ToGuest frame;
        if (!frame.ParseFromString(bytes)) throw UserError("the gateway sends what makes no sense");
        is_in_ = is_in_ || frame.has_welcome();
        is_refused_ = is_refused_ || frame.has_refusal();
        size_t others = 0;  // bytes of this frame that are of no node
        for (const gateway::Sample& sample : frame.samples().samples()) {
            if (sample.topic() == gateway::Sample::STATUS && status_.ParseFromString(sample.payload()))
                wants_nodes_ = status_.node_count();
            if (sample.topic() == gateway::Sample::TOOL_STATE) tool_bytes_ += sample.payload().size();
            if (sample.topic() != gateway::Sample::NODE_MESH) {
                others += sample.ByteSizeLong();
                continue;
            }
            node_bytes_ += sample.payload().size();
            if (const auto node = decodeNodeMesh(sample.payload(), uint32_t(sample.key())))
                triangles_ += node->mesh.indices.size() / 3;
            if (sample.payload().empty()) {
                nodes_.erase(sample.key());
            } else {
                nodes_.insert(sample.key());
            }
        }
        if (node_bytes_ != before) node_frame_bytes_ += bytes.size() - others;
    }

    WebSocketClient socket_;
    uint64_t received_ = 0, node_bytes_ = 0, node_frame_bytes_ = 0, triangles_ = 0, tool_bytes_ = 0,
             frames_ = 0, wants_nodes_ = 0;
    std::unordered_set<uint64_t> nodes_;
    topics::Status status_;
    bool is_in_ = false, is_refused_ = false;
    GuestClock::time_point announce_due_{};
};

using Guests = std::vector<std::unique_ptr<BenchGuest>>;

void stepAll(const Guests& guests) {
    const auto now = GuestClock::now();
    for (const auto& guest : guests) guest->step(now);
    std::this_thread::sleep_for(kGuestRound);
}

size_t countOf(const Guests& guests, bool (BenchGuest::*is)() const) {
    return size_t(std::ranges::count_if(guests, [is](const auto& guest) { return (*guest.*is)(); }));
}

std::vector<std::string> tokensOf(const std::string& file) {
    std::ifstream stream(file);
    std::vector<std::string> tokens;
    for (std::string line; std::getline(stream, line);) {
        const size_t hash = line.find('#');
        tokens.push_back(hash == std::string::npos ? line : line.substr(hash + 1));
    }
    if (tokens.empty()) throw UserError(file + ": has no tokens, one in a line");
    return tokens;
}

// One after the other; a gateway that has its hands full turns some away, and they come again.
Guests comeIn(const BenchWish& wish) {
    const std::vector<std::string> tokens = tokensOf(wish.tokens);
    const auto start = GuestClock::now();
    const auto end = start + std::chrono::seconds(wish.patience_s);
    Guests guests;
    int tries = 0;
    while (guests.size() < wish.guests) {
        if (GuestClock::now() > end)
            throw UserError("only " + std::to_string(guests.size()) + " guests came in");
        ++tries;
        try {
            const std::string& token = tokens[guests.size() * tokens.size() / wish.guests];
            guests.push_back(std::make_unique<BenchGuest>(wish.target, token));
        } catch (const UserError& error) {
            std::cerr << error.what() << '\n';
            continue;
        }
        while (!guests.back()->isIn() && !guests.back()->isOut()) stepAll(guests);
        if (guests.back()->isOut()) guests.pop_back();
    }
    std::cout << guests.size() << " guests came in within "
              << number(Seconds(GuestClock::now() - start).count()) << " s, " << tries << " tries"
              << std::endl;
    while (countOf(guests, &BenchGuest::isComplete) < guests.size() && GuestClock::now() < end)
        stepAll(guests);
    std::cout << countOf(guests, &BenchGuest::isComplete) << " have the whole model after "
              << number(Seconds(GuestClock::now() - start).count()) << " s" << std::endl;
    const BenchGuest& last = *guests.back();
    std::cout << "the last one: " << last.triangles() << " triangles, per triangle "
              << number(double(last.nodeFrameBytes()) / double(last.triangles())) << " bytes, as over DDS "
              << number(double(last.nodeBytes()) / double(last.triangles())) << std::endl;
    return guests;
}

double peakMibOf(int pid) {
    std::ifstream status("/proc/" + std::to_string(pid) + "/status");
    for (std::string word; status >> word;) {
        double kib = 0;
        if (word == "VmHWM:" && status >> kib) return kib / kKib;
    }
    return 0;
}

// What all guests together were sent so far, bytes.
struct Sent {
    double all = 0, nodes = 0, tool = 0, frames = 0;
};

Sent sentTo(const Guests& guests) {
    Sent sent;
    for (const auto& guest : guests) {
        sent.all += double(guest->received());
        sent.nodes += double(guest->nodeBytes());
        sent.tool += double(guest->toolBytes());
        sent.frames += double(guest->frames());
    }
    return sent;
}

void measure(const BenchWish& wish, const Guests& guests) {
    const Sent before = sentTo(guests);
    std::vector<double> used;
    for (const int pid : wish.pids) used.push_back(processorSeconds(pid));
    const auto start = GuestClock::now();
    while (GuestClock::now() - start < std::chrono::seconds(wish.seconds)) stepAll(guests);
    const double time = Seconds(GuestClock::now() - start).count();
    const Sent after = sentTo(guests);
    const auto rate = [&](double Sent::*of) {
        return (after.*of - before.*of) / time / double(guests.size());
    };
    std::cout << "each was sent " << number(rate(&Sent::all) / kKib) << " KiB/s in " << number(time)
              << " s: nodes " << number(rate(&Sent::nodes) / kKib) << ", tool "
              << number(rate(&Sent::tool) / kKib) << ", in " << number(rate(&Sent::frames))
              << " frames/s; all together "
              << number(kBitsOfByte * rate(&Sent::all) * double(guests.size()) / kMega) << " Mbit/s; "
              << countOf(guests, &BenchGuest::isOut) << " were lost, "
              << countOf(guests, &BenchGuest::isComplete) << " have the whole model\n";
    for (size_t n = 0; n < wish.pids.size(); ++n)
        std::cout << "process " << wish.pids[n] << ": "
                  << number(100 * (processorSeconds(wish.pids[n]) - used[n]) / time)
                  << " % of a core, at most " << number(peakMibOf(wish.pids[n])) << " MiB\n";
}

int bench(int argc, char** argv) {
    BenchWish wish;
    CLI::App app{"Guests of a gateway: what they are sent, and what it costs."};
    app.add_option("--host", wish.target.host, "The gateway, or its relay")->capture_default_str();
    app.add_option("--port", wish.target.port, "Its port")->capture_default_str();
    app.add_option("--fingerprint", wish.target.fingerprint, "As the gateway printed it")->required();
    app.add_option("--tokens", wish.tokens, "Tokens or links, one in a line; guests share them evenly")
        ->required();
    app.add_option("--guests", wish.guests, "So many come")->check(CLI::Range(1, 1000));
    app.add_option("--seconds", wish.seconds, "So long they are watched")->capture_default_str();
    app.add_option("--patience-s", wish.patience_s, "So long they may take to come")->capture_default_str();
    app.add_option("--pid", wish.pids, "Processes whose cost is told");
    if (!parseCommandLine(app, argc, argv, "guest_bench")) return 0;
    allowDescriptors(wish.guests + 64);
    const Guests guests = comeIn(wish);
    measure(wish, guests);
    return 0;
}

}  // namespace
}  // namespace bonemill::bench

int main(int argc, char** argv) {
    return bonemill::runProgram([&] { return bonemill::bench::bench(argc, argv); });
}
