#include "render_client/apps/render_client/connect_gateway.h"

#include <spdlog/spdlog.h>

#include <fstream>
#include <memory>

#include "common/base/user_error.h"
#include "common/files/whole_file.h"
#include "render_client/web/connect/gateway_session.h"
#include "render_client/web/gateway/guest_list.h"
#include "render_client/web/secrets/secrets.h"

namespace bonemill {
namespace {

constexpr std::chrono::seconds kPatience{10};

// The token itself is kept nowhere.
std::filesystem::path ticketFile(const std::string& token) {
    return gateway::configFolder() / "tickets" / sha256Hex(token);
}

std::string keptTicket(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::string ticket;
    std::getline(stream, ticket);
    return ticket;
}

void keepTicket(const std::filesystem::path& file, const std::string& ticket) {
    try {
        writePrivateFile(file, ticket);
    } catch (const std::exception& error) {
        spdlog::warn("{}; the next run needs another invitation", error.what());
    }
}

std::shared_ptr<connect::GatewaySession> sessionOf(const ConnectOptions& options, const std::string& ticket) {
    if (!ticket.empty()) {
        try {
            return std::make_shared<connect::GatewaySession>(options.target, ticket, kPatience);
        } catch (const UserError&) {
            // The gateway has forgotten it, or does not answer: the token tells.
        }
    }
    return std::make_shared<connect::GatewaySession>(options.target, options.token, kPatience);
}

}  // namespace

void connectToGateway(ClientOptions& options) {
    ConnectOptions& wish = *options.connect;
    const std::filesystem::path file = ticketFile(wish.token);
    const auto session = sessionOf(wish, keptTicket(file));
    keepTicket(file, session->welcome().ticket());
    wish.token.clear();
    options.subscriber.name = session->welcome().name();
    options.subscriber.role = session->welcome().role();
    options.subscriber.remote = session;
}

}  // namespace bonemill
