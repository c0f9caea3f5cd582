// The gateway's port: TLS, the page's files, and a WebSocket per guest, on Boost.Asio and Beast.
//
// One thread constructs and serves. Connections, their times and their headers are bounded; the log holds no
// tokens, and its lines are bounded, too.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "common/tcp/descriptor.h"
#include "render_client/web/gateway/gateway_certificate.h"
#include "render_client/web/gateway/gateway_options.h"

namespace bonemill::gateway {

class GatewayServer {
  public:
    // Listens from now on, there or where `listener` already does. Throws UserError.
    explicit GatewayServer(const GatewayOptions& options, Descriptor listener = {});
    ~GatewayServer();

    // Serves until `stop`, which is asked twenty times per second as long as all goes well.
    void serveUntil(const std::function<bool()>& stop);

    uint16_t port() const;
    const GatewayCertificate& certificate() const;
    bool hasPage() const;

  private:
    struct Port;
    std::unique_ptr<Port> port_;
};

}  // namespace bonemill::gateway
