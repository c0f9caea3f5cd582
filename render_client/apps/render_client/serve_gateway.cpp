#include "render_client/apps/render_client/serve_gateway.h"

#include <iostream>

#include "render_client/apps/render_client/stop_signal.h"
#include "render_client/viewer_options/network_place.h"
#include "render_client/web/gateway/gateway_server.h"

namespace bonemill {

int runGateway(const ClientOptions& options) {
    gateway::GatewayServer server(*options.serve);
    std::cout << "gateway of session " << options.serve->session << ": https://"
              << textOf(NetworkPlace{options.serve->address, server.port()}) << '\n';
    if (options.serve->via)
        std::cout << "through the relay, once it is reached: https://"
                  << textOf(NetworkPlace{options.serve->via->host, options.serve->via->port}) << '\n';
    if (server.certificate().is_self_made)
        std::cout << "certificate of its own making, which browsers ask about; fingerprint (SHA-256): "
                  << server.certificate().fingerprint << '\n';
    if (!server.hasPage()) std::cout << "the page was not built: only viewers with --connect can come\n";
    std::cout << std::flush;
    server.serveUntil(stopRequested);
    return 0;
}

}  // namespace bonemill
