// This client without a picture prints "<node count> <node digest>" each time its model is complete and
// has changed.
#include <iostream>

#include "common/log/log.h"
#include "render_client/link/subscribe/scene_subscriber.h"

int main(int, char** argv) {
    using namespace bonemill;
    setUpLog("synthetic_client", "info");  // its standard output is for the test
    SceneSubscriber subscriber({.domain = static_cast<uint32_t>(std::stoul(argv[1])),
                                .session = static_cast<uint32_t>(std::stoul(argv[2]))});
    NodeDigest printed;
    while (true) {
        subscriber.waitForData(std::chrono::milliseconds(100));
        subscriber.poll();
        if (!subscriber.isComplete() || subscriber.digest() == printed) continue;
        printed = subscriber.digest();
        std::cout << printed.count() << ' ' << printed.value() << std::endl;
    }
}
