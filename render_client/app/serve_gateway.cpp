#include "render_client/app/serve_gateway.h"

#include <iostream>

#include "render_client/app/stop_signal.h"
#include "render_client/gateway/gateway_server.h"

namespace bonemill {

int runGateway(const ClientOptions& options) {
    gateway::GatewayServer server(*options.serve);
    const std::string& address = options.serve->address;
    const bool is_v6 = address.find(':') != std::string::npos;
    std::cout << "gateway of session " << options.serve->session << ": https://"
              << (is_v6 ? "[" + address + "]" : address) << ':' << server.port() << '\n';
    if (server.certificate().is_self_made)
        std::cout << "certificate of its own making, which browsers ask about; fingerprint (SHA-256): "
                  << server.certificate().fingerprint << '\n';
    if (!server.hasPage()) std::cout << "the page was not built: only viewers with --connect can come\n";
    std::cout << std::flush;
    server.serveUntil(stopRequested);
    return 0;
}

}  // namespace bonemill
