// This is a viewer without a picture, steered line by line on stdin (domain and session are arguments):
//   join    joins the session; answers "<s until the model was complete> <nodes>"
//   state   waits until the model is complete again; answers "<node count> <node digest> <processor s>"
#include <poll.h>
#include <sys/resource.h>
#include <unistd.h>

#include <iostream>
#include <memory>

#include "common/base/units.h"
#include "common/rt/clock.h"
#include "render_client/link/subscribe/scene_subscriber.h"

namespace {

using namespace bonemill;
constexpr std::chrono::milliseconds kFrame{16};

bool hasLine() {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    return poll(&input, 1, 0) > 0;
}

void pollUntilComplete(SceneSubscriber& subscriber) {
    do {
        subscriber.waitForData(kFrame);
        subscriber.poll();
    } while (!subscriber.isComplete());
}

double processorSeconds() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return double(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           kMicrosecond * double(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

}  // namespace

int main(int, char** argv) {
    const SubscriberOptions options{.domain = uint32_t(std::stoul(argv[1])),
                                    .session = uint32_t(std::stoul(argv[2]))};
    std::unique_ptr<SceneSubscriber> subscriber;
    for (std::string line; std::getline(std::cin, line);) {
        if (line == "join") {
            const int64_t start_ns = monotonicNowNs();
            subscriber = std::make_unique<SceneSubscriber>(options);
            pollUntilComplete(*subscriber);
            std::cout << secondsOfNs(monotonicNowNs() - start_ns) << ' ' << subscriber->digest().count()
                      << std::endl;
        } else if (subscriber) {
            pollUntilComplete(*subscriber);
            std::cout << subscriber->digest().count() << ' ' << subscriber->digest().value() << ' '
                      << processorSeconds() << std::endl;
        }
        while (subscriber && !hasLine()) {
            subscriber->waitForData(kFrame);
            subscriber->poll();
        }
    }
}
