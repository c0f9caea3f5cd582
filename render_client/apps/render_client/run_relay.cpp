#include "render_client/apps/render_client/run_relay.h"

#include <spdlog/spdlog.h>

#include <iostream>

#include "render_client/apps/render_client/stop_signal.h"
#include "render_client/viewer_options/network_place.h"
#include "render_client/web/relay/relay.h"

namespace bonemill {

int runRelay(const ClientOptions& options) {
    Relay relay(*options.relay);
    std::cout << "relay for a gateway with --via: "
              << textOf(NetworkPlace{options.relay->address, relay.port()}) << std::endl;
    relay.run(stopRequested);
    const Relay::Counts counts = relay.counts();
    spdlog::info("the relay ends: it passed on {} bytes and turned {} lines away", counts.bytes,
                 counts.refused);
    return 0;
}

}  // namespace bonemill
