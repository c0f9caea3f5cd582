#include "render_client/app/connect_gateway.h"

#include <fcntl.h>
#include <unistd.h>

#include <fstream>
#include <memory>

#include "common/user_error.h"
#include "render_client/connect/gateway_session.h"
#include "render_client/gateway/guest_list.h"
#include "render_client/gateway/secrets.h"

namespace bonemill {
namespace {

constexpr std::chrono::seconds kPatience{10};

// The token itself is kept nowhere.
std::filesystem::path ticketFile(const std::string& token) {
    return gateway::configFolder() / "tickets" / gateway::sha256Hex(token);
}

std::string keptTicket(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::string ticket;
    std::getline(stream, ticket);
    return ticket;
}

// Without it the next run needs another invitation, but this one goes on.
void keepTicket(const std::filesystem::path& file, const std::string& ticket) {
    std::error_code ignored;
    std::filesystem::create_directories(file.parent_path(), ignored);
    const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (descriptor < 0) return;
    if (write(descriptor, ticket.data(), ticket.size()) < 0) std::filesystem::remove(file, ignored);
    close(descriptor);
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
