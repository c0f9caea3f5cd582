// A viewer without a picture. Prints one JSON line every 100 ms: what it shows, and how old that ever was.
//   probe_viewer --session N [--domain D] [--profile ...] [--interface ...] [--peer ...]
// longest_age_ms: of the tool state, since the first one; the server's clock and this one's are the same (one
// PC). longest_behind_ms: without the whole model of the newest status, since it was whole for the first
// time.
#include <cinttypes>
#include <cstdio>
#include <iostream>

#include "common/dds/network_cli.h"
#include "common/user_error.h"
#include "render_client/subscribe/scene_subscriber.h"

namespace {

using namespace bonemill;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

class Probe {
  public:
    explicit Probe(const SubscriberOptions& options) : subscriber_(options) {}

    void run() {
        for (Clock::time_point due = Clock::now();;) {
            subscriber_.waitForData(10ms);
            measure();  // what was shown until now
            changes_ += subscriber_.poll().nodes.size();
            if (subscriber_.isComplete()) whole_since_ = Clock::now();
            if (Clock::now() < due) continue;
            due = Clock::now() + 100ms;
            print();
        }
    }

  private:
    void measure() {
        using std::chrono::milliseconds;
        if (subscriber_.toolState()) {
            const auto now = std::chrono::system_clock::now().time_since_epoch();
            const auto age = now - std::chrono::nanoseconds(subscriber_.toolState()->stamp_ns());
            longest_age_ = std::max(longest_age_, std::chrono::round<milliseconds>(age));
        }
        if (whole_since_)
            longest_behind_ =
                std::max(longest_behind_, std::chrono::round<milliseconds>(Clock::now() - *whole_since_));
    }
    void print() const {
        std::printf("{\"complete\":%s,\"server\":%s,\"nodes\":%u,\"digest\":\"%016" PRIx64
                    "\",\"changes\":%zu,\"longest_age_ms\":%lld,\"longest_behind_ms\":%lld}\n",
                    subscriber_.isComplete() ? "true" : "false", subscriber_.hasServer() ? "true" : "false",
                    subscriber_.digest().count(), subscriber_.digest().value(), changes_,
                    static_cast<long long>(longest_age_.count()),
                    static_cast<long long>(longest_behind_.count()));
        std::fflush(stdout);
    }

    SceneSubscriber subscriber_;
    size_t changes_ = 0;
    std::optional<Clock::time_point> whole_since_;
    std::chrono::milliseconds longest_age_{0}, longest_behind_{0};
};

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("A viewer without a picture", "probe_viewer");
    SubscriberOptions subscriber;
    dds::NetworkOptions network;
    app.add_option("--session", subscriber.session)->required();
    app.add_option("--domain", subscriber.domain);
    dds::addNetworkOptions(app, network);
    CLI11_PARSE(app, argc, argv);
    try {
        dds::setNetwork(network);
        Probe(subscriber).run();
    } catch (const UserError& error) {
        std::cerr << "error: " << error.what() << '\n';
        return kUserErrorExitCode;
    }
}
