#include "render_client/web/gateway/gateway_server.h"

#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "common/base/user_error.h"
#include "common/files/config_folder.h"
#include "common/files/file_stamp.h"
#include "common/tcp/listen.h"
#include "render_client/web/gateway/gateway.h"
#include "render_client/web/gateway/gateway_connection.h"
#include "render_client/web/gateway/gateway_tls.h"
#include "render_client/web/gateway/relayed_guests.h"

namespace bonemill::gateway {
namespace {

namespace net = boost::asio;

constexpr std::chrono::milliseconds kStep{5}, kIdleStep{50}, kRound{50};
constexpr std::chrono::seconds kCertificateRound{1};
constexpr CrowdBounds kMaxConnections{256, 96, 192};  // that are no guest's
constexpr size_t kSpareDescriptors = 128;             // for DDS, files and the relay
constexpr int kMaxAccepted = 32;                      // in one round: others are to be served, too

net::ip::tcp protocolOf(int socket) {
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
    return address.ss_family == AF_INET6 ? net::ip::tcp::v6() : net::ip::tcp::v4();
}

GatewayCertificate certificateFor(const GatewayOptions& options) {
    return options.certificate.empty() ? selfMadeCertificate(configFolder())
                                       : certificateOf(options.certificate, options.key);
}

std::string stampOfBoth(const std::filesystem::path& certificate, const std::filesystem::path& key) {
    return stampOf(certificate) + ' ' + stampOf(key);
}

std::vector<std::string> otherNames(const GatewayOptions& options) {
    std::vector<std::string> names = options.names;
    if (options.via) names.push_back(options.via->host);
    return names;
}

}  // namespace

struct GatewayServer::Port {
    Port(const GatewayOptions& options, Descriptor listening);
    ~Port();

    void listen();
    void acceptAll();
    void admit(Descriptor line, const GuestOrigin& origin);
    void adoptRelayed();
    bool findPlaceFor(const GuestOrigin& comer);
    void forgetEnded();
    void rereadCertificate(Gateway::Clock::time_point now);
    void step();

    const std::vector<std::string> other_names;
    std::string certificate_stamp;  // of its files, from before they were read
    GatewayCertificate certificate;
    Gateway::Clock::time_point certificate_due{};
    StaticPages pages;
    HostNames names;
    net::ssl::context tls;
    Gateway gateway;
    Lobby lobby;
    net::io_context io{1};
    net::posix::stream_descriptor listener;
    const uint16_t number;
    bool is_listening = false;
    net::steady_timer timer{io};
    std::vector<std::shared_ptr<GatewayConnection>> connections;  // in the order in which they came
    size_t most_lines;
    std::optional<RelayedGuests> relayed;
};

GatewayServer::Port::Port(const GatewayOptions& options, Descriptor listening)
    : other_names(otherNames(options)),
      certificate_stamp(stampOfBoth(options.certificate, options.key)),
      certificate(certificateFor(options)),
      pages(options.page),
      names(certificate, other_names),
      tls(tlsOf(certificate)),
      gateway(options),
      lobby{gateway, tls, {pages, names, !certificate.is_self_made}},
      listener(io, (listening ? std::move(listening) : listenOn(options.address, options.port)).release()),
      number(portOf(listener.native_handle())) {
    const size_t wanted = kMaxConnections.all + options.most_guests + 2 * Gateway::kMaxUnknown.all;
    most_lines = allowDescriptors(wanted + kSpareDescriptors) - kSpareDescriptors;
    if (options.via) relayed.emplace(*options.via, [this] { net::post(io, [this] { adoptRelayed(); }); });
    step();
}

GatewayServer::Port::~Port() {
    relayed.reset();  // its thread posts here
    for (const auto& connection : connections) connection->end();
}

void GatewayServer::Port::listen() {
    is_listening = true;
    listener.async_wait(net::posix::stream_descriptor::wait_read,
                        [this](const boost::system::error_code& error) {
                            is_listening = false;
                            if (!error) acceptAll();
                        });
}

void GatewayServer::Port::acceptAll() {
    for (int n = 0; n < kMaxAccepted; ++n) {
        PeerAddress from{};
        Descriptor line = acceptFrom(listener.native_handle(), from);
        if (!line) {
            // None waits; or there is no descriptor left, and the next step tries again.
            if (n > 0) listen();
            return;
        }
        admit(std::move(line), {textOf(from)});
    }
    listen();
}

void GatewayServer::Port::admit(Descriptor line, const GuestOrigin& origin) {
    if (!findPlaceFor(origin)) return;
    forgetEnded();
    if (connections.size() >= most_lines) return;
    const auto protocol = protocolOf(line.get());
    connections.push_back(std::make_shared<GatewayConnection>(
        net::ip::tcp::socket(io, protocol, line.release()), origin, lobby));
    connections.back()->start();
}

void GatewayServer::Port::adoptRelayed() {
    if (!relayed) return;
    for (RelayedGuests::Arrival& arrival : relayed->take()) admit(std::move(arrival.line), arrival.origin);
}

bool GatewayServer::Port::findPlaceFor(const GuestOrigin& comer) {
    Crowd crowd(comer);
    std::vector<GatewayConnection*> there;
    for (const auto& connection : connections) {
        if (connection->isGuests() || connection->hasEnded()) continue;
        crowd.add(connection->origin());
        there.push_back(connection.get());
    }
    return crowd.findPlace(kMaxConnections, [&](size_t n) { there[n]->end(); });
}

void GatewayServer::Port::forgetEnded() {
    std::erase_if(connections, [](const auto& connection) { return connection->hasEnded(); });
}

// One of an authority is renewed every few weeks, while guests are here: they keep theirs, who comes now is
// shown the new one.
void GatewayServer::Port::rereadCertificate(Gateway::Clock::time_point now) {
    if (certificate.is_self_made || now < certificate_due) return;
    certificate_due = now + kCertificateRound;
    std::string stamp = stampOfBoth(certificate.certificate, certificate.key);
    if (stamp == std::exchange(certificate_stamp, stamp)) return;
    try {
        GatewayCertificate renewed = certificateOf(certificate.certificate, certificate.key);
        net::ssl::context renewed_tls = tlsOf(renewed);
        names = HostNames(renewed, other_names);
        tls = std::move(renewed_tls);
        certificate = std::move(renewed);
        spdlog::info("the certificate was renewed; fingerprint (SHA-256): {}", certificate.fingerprint);
    } catch (const UserError& error) {
        spdlog::warn("{}; the certificate before stays in use", error.what());
    }
}

void GatewayServer::Port::step() {
    const auto now = Gateway::Clock::now();
    rereadCertificate(now);
    if (!is_listening) listen();
    gateway.step(now);
    for (size_t n = 0; n < connections.size(); ++n) connections[n]->step(now);
    forgetEnded();
    const bool has_guests = std::ranges::any_of(connections, [](const auto& one) { return one->isGuests(); });
    timer.expires_after(has_guests ? kStep : kIdleStep);
    timer.async_wait([this](const boost::system::error_code& error) {
        if (!error) step();
    });
}

GatewayServer::GatewayServer(const GatewayOptions& options, Descriptor listener)
    : port_(std::make_unique<Port>(options, std::move(listener))) {}

GatewayServer::~GatewayServer() = default;

void GatewayServer::serveUntil(const std::function<bool()>& stop) {
    while (!stop()) port_->io.run_for(kRound);
}

uint16_t GatewayServer::port() const {
    return port_->number;
}

const GatewayCertificate& GatewayServer::certificate() const {
    return port_->certificate;
}

bool GatewayServer::hasPage() const {
    return port_->pages.isBuilt();
}

}  // namespace bonemill::gateway
