// This is a viewer without a picture. It prints one JSON line every 100 ms that says what it shows.
//   probe_viewer --session N [--domain D] [--profile ...] [--interface ...] [--peer ...]
#include <cinttypes>
#include <cstdio>

#include "common/cli/command_line.h"
#include "common/dds/network_cli.h"
#include "common/run_program.h"
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
            changes_ += subscriber_.poll().nodes.size();
            if (Clock::now() < due) continue;
            due = Clock::now() + 100ms;
            print();
        }
    }

  private:
    void print() const {
        std::printf("{\"complete\":%s,\"server\":%s,\"nodes\":%u,\"digest\":\"%016" PRIx64
                    "\",\"changes\":%zu}\n",
                    subscriber_.isComplete() ? "true" : "false", subscriber_.hasServer() ? "true" : "false",
                    subscriber_.digest().count(), subscriber_.digest().value(), changes_);
        std::fflush(stdout);
    }

    SceneSubscriber subscriber_;
    size_t changes_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
    return runProgram([&] {
        CLI::App app("A viewer without a picture", "probe_viewer");
        SubscriberOptions subscriber;
        dds::NetworkOptions network;
        app.add_option("--session", subscriber.session)->required();
        app.add_option("--domain", subscriber.domain);
        dds::addNetworkOptions(app, network);
        if (!parseCommandLine(app, argc, argv, "probe_viewer")) return 0;
        dds::setNetwork(network);
        Probe(subscriber).run();
        return 0;
    });
}
