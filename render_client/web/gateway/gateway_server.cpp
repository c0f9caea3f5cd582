#include "render_client/web/gateway/gateway_server.h"

#include <libwebsockets.h>
#include <openssl/ssl.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/tcp/listen.h"
#include "render_client/web/gateway/gateway.h"
#include "render_client/web/gateway/relayed_guests.h"
#include "render_client/web/gateway/static_pages.h"

namespace bonemill::gateway {
namespace {

constexpr int64_t kStepUs = 5000, kIdleStepUs = 50000;
constexpr CrowdBounds kMaxConnections{256, 96, 192};  // that are no guest's
constexpr unsigned kHeaderTimeS = 5;
constexpr unsigned kHeaderBytes = 4096;
constexpr size_t kSpareDescriptors = 128;  // for DDS, files and the relay
constexpr size_t kPieceBytes = 16 << 10;   // of a guest's frame, as it arrives

// In the connection's own memory, which libwebsockets sets to zero.
struct GuestConnection {
    Guest* guest;
    std::string* frame;  // as much of it as has come
};

std::string headerOf(lws* connection, lws_token_indexes header) {
    std::string value(size_t(lws_hdr_total_length(connection, header)) + 1, '\0');
    const int length = lws_hdr_copy(connection, value.data(), int(value.size()), header);
    value.resize(size_t(std::max(length, 0)));
    return value;
}

// A page of elsewhere must not speak through the user's browser. What is no browser names no origin.
bool isOurOwn(lws* connection) {
    const std::string origin = headerOf(connection, WSI_TOKEN_ORIGIN);
    return origin.empty() ||
           strcasecmp(origin.c_str(), ("https://" + headerOf(connection, WSI_TOKEN_HOST)).c_str()) == 0;
}

// What libwebsockets' callbacks return does not end a WebSocket that has just been opened.
void kill(lws* connection) {
    lws_set_timeout(connection, PENDING_TIMEOUT_USER_REASON_BASE, LWS_TO_KILL_ASYNC);
}

// Strangers can provoke these lines: they must not fill the log.
void logLine(int, const char* line) {
    std::string text(line);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    spdlog::debug("network: {}", text);
}

}  // namespace

struct GatewayServer::Port {
    explicit Port(const GatewayOptions& options);
    ~Port() {
        relayed.reset();  // its thread wakes the context
        if (context) lws_context_destroy(context);
    }
    static Port& of(lws* connection) {
        return *static_cast<Port*>(lws_context_user(lws_get_context(connection)));
    }
    static int onHttp(lws* connection, lws_callback_reasons reason, void* user, void* data, size_t length);
    static int onGuest(lws* connection, lws_callback_reasons reason, void* user, void* data, size_t length);
    static void onTime(lws_sorted_usec_list_t* list);
    bool findPlaceFor(const GuestOrigin& comer);
    GuestOrigin takeArrival(const lws* connection);
    int accept(int socket);
    void adoptRelayed();
    int open(lws* connection, GuestConnection& place);
    void close(lws* connection, GuestConnection& place);
    int take(lws* connection, GuestConnection& place, const char* data, size_t length);
    int write(lws* connection, GuestConnection& place);
    void step();

    GatewayCertificate certificate;
    StaticPages pages;
    Gateway gateway;
    struct Arrival {
        lws* connection;
        GuestOrigin origin;
    };
    std::vector<Arrival> arrivals;  // before they are guests', the oldest first
    std::map<lws*, Guest*> guests;
    struct Timer {
        lws_sorted_usec_list_t list;  // first: libwebsockets gives it back
        Port* owner;
    } timer{};
    lws_context* context = nullptr;
    lws_vhost* vhost = nullptr;
    std::optional<GuestOrigin> adopting;  // whose line libwebsockets is being given
    std::optional<RelayedGuests> relayed;
};

GatewayServer::Port::Port(const GatewayOptions& options)
    : certificate(options.certificate.empty() ? selfMadeCertificate(configFolder())
                                              : certificateOf(options.certificate, options.key)),
      pages(options.page),
      gateway(options) {
    static const lws_protocols kProtocols[] = {
        {"http", onHttp, sizeof(HttpAnswer), 0, 0, nullptr, 0},
        {"bonemill.v1", onGuest, sizeof(GuestConnection), kPieceBytes, 0, nullptr, 0},
        {nullptr, nullptr, 0, 0, 0, nullptr, 0}};
    static const lws_retry_bo_t kPings{nullptr, 0, 0, 20, 40, 0};
    lws_set_log_level(LLL_ERR | LLL_WARN, logLine);
    const bool is_everywhere = options.address == "0.0.0.0" || options.address == "::";
    lws_context_creation_info info{};
    info.port = options.port;
    info.iface = is_everywhere ? nullptr : options.address.c_str();
    info.protocols = kProtocols;
    info.user = this;
    info.server_string = "bonemill";
    info.options = LWS_SERVER_OPTION_DO_SSL_GLOBAL_INIT | LWS_SERVER_OPTION_EXPLICIT_VHOSTS |
                   LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND;
    if (options.address.find(':') == std::string::npos) info.options |= LWS_SERVER_OPTION_DISABLE_IPV6;
    const std::string certificate_file = certificate.certificate.string(),
                      key_file = certificate.key.string();
    info.ssl_cert_filepath = certificate_file.c_str();
    info.ssl_private_key_filepath = key_file.c_str();
    info.ssl_options_set = SSL_OP_NO_SSLv3 | SSL_OP_NO_TLSv1 | SSL_OP_NO_TLSv1_1 | SSL_OP_NO_RENEGOTIATION;
    info.alpn = "http/1.1";
    info.timeout_secs = kHeaderTimeS;
    info.keepalive_timeout = int(kHeaderTimeS);
    info.max_http_header_data = kHeaderBytes;
    info.max_http_header_pool = kMaxConnections.all;
    const size_t most_lines = kMaxConnections.all + options.most_guests + 2 * Gateway::kMaxUnknown.all;
    info.fd_limit_per_thread = unsigned(allowDescriptors(most_lines + kSpareDescriptors) - kSpareDescriptors);
    info.retry_and_idle_policy = &kPings;
    info.vhost_name = "gateway";
    context = lws_create_context(&info);
    if (!context) throw UserError("library: libwebsockets gives no context");
    vhost = lws_create_vhost(context, &info);
    if (!vhost || lws_get_vhost_listen_port(vhost) <= 0) {
        lws_context_destroy(std::exchange(context, nullptr));
        throw UserError("--serve " + options.address + ":" + std::to_string(options.port) +
                        ": cannot listen there: is the port taken, or not this PC's address?");
    }
    timer.owner = this;
    lws_sul_schedule(context, 0, &timer.list, onTime, kStepUs);
    // It is the only call of libwebsockets that other threads may make.
    if (options.via) relayed.emplace(*options.via, [this] { lws_cancel_service(context); });
}

void GatewayServer::Port::onTime(lws_sorted_usec_list_t* list) {
    Port& port = *reinterpret_cast<Timer*>(list)->owner;
    port.step();
    lws_sul_schedule(port.context, 0, &port.timer.list, onTime, port.guests.empty() ? kIdleStepUs : kStepUs);
}

int GatewayServer::Port::onHttp(lws* connection, lws_callback_reasons reason, void* user, void* data,
                                size_t) {
    Port& port = of(connection);
    switch (reason) {
        case LWS_CALLBACK_FILTER_NETWORK_CONNECTION:
            return port.accept(int(reinterpret_cast<intptr_t>(data)));
        case LWS_CALLBACK_SERVER_NEW_CLIENT_INSTANTIATED: {
            char address[64] = "";
            lws_get_peer_simple(connection, address, sizeof address);
            port.arrivals.push_back({connection, port.adopting.value_or(GuestOrigin{address})});
            return 0;
        }
        case LWS_CALLBACK_EVENT_WAIT_CANCELLED:
            port.adoptRelayed();
            return 0;
        case LWS_CALLBACK_WSI_DESTROY:
            port.takeArrival(connection);
            return 0;
        case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
            return -1;  // a WebSocket without our subprotocol
        case LWS_CALLBACK_HTTP:
            return beginAnswer(connection, port.pages, *static_cast<HttpAnswer*>(user));
        case LWS_CALLBACK_HTTP_WRITEABLE:
            return continueAnswer(connection, *static_cast<HttpAnswer*>(user));
        default:
            return 0;
    }
}

int GatewayServer::Port::accept(int socket) {
    char address[64] = "";
    lws_get_peer_simple_fd(socket, address, sizeof address);
    return findPlaceFor({address}) ? 0 : 1;
}

bool GatewayServer::Port::findPlaceFor(const GuestOrigin& comer) {
    Crowd crowd(comer);
    for (const Arrival& arrival : arrivals) crowd.add(arrival.origin);
    if (crowd.hasPlace(kMaxConnections)) return true;
    const auto leaver = crowd.whoMakesRoom(kMaxConnections);
    if (!leaver) return false;
    kill(arrivals[*leaver].connection);
    arrivals.erase(arrivals.begin() + std::ptrdiff_t(*leaver));
    return true;
}

// Returns where it came from; it is no arrival any more.
GuestOrigin GatewayServer::Port::takeArrival(const lws* connection) {
    const auto arrival = std::ranges::find(arrivals, connection, &Arrival::connection);
    if (arrival == arrivals.end()) return {};
    GuestOrigin origin = std::move(arrival->origin);
    arrivals.erase(arrival);
    return origin;
}

// They are connections as any other from here on: libwebsockets speaks TLS with them, and tells of each
// before it returns.
void GatewayServer::Port::adoptRelayed() {
    if (!relayed) return;
    for (RelayedGuests::Arrival& arrival : relayed->take()) {
        if (!findPlaceFor(arrival.origin)) continue;
        adopting = std::move(arrival.origin);
        lws_adopt_socket_vhost(vhost, arrival.line.release());
        adopting.reset();
    }
}

int GatewayServer::Port::onGuest(lws* connection, lws_callback_reasons reason, void* user, void* data,
                                 size_t length) {
    Port& port = of(connection);
    GuestConnection* const place = static_cast<GuestConnection*>(user);
    switch (reason) {
        case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
            return headerOf(connection, WSI_TOKEN_GET_URI) == "/session" && isOurOwn(connection) ? 0 : -1;
        case LWS_CALLBACK_ESTABLISHED:
            return port.open(connection, *place);
        case LWS_CALLBACK_RECEIVE:
            return port.take(connection, *place, static_cast<const char*>(data), length);
        case LWS_CALLBACK_SERVER_WRITEABLE:
            return port.write(connection, *place);
        case LWS_CALLBACK_CLOSED:
            port.close(connection, *place);
            return 0;
        default:
            return 0;
    }
}

int GatewayServer::Port::open(lws* connection, GuestConnection& place) {
    place.guest = gateway.come(takeArrival(connection), Gateway::Clock::now());
    if (!place.guest) {
        kill(connection);
        return 0;
    }
    place.frame = new std::string;
    guests.emplace(connection, place.guest);
    return 0;
}

void GatewayServer::Port::close(lws* connection, GuestConnection& place) {
    if (place.guest) gateway.leave(place.guest);
    delete place.frame;
    place = {};
    guests.erase(connection);
}

int GatewayServer::Port::take(lws* connection, GuestConnection& place, const char* data, size_t length) {
    if (!place.guest) return -1;
    const auto now = Gateway::Clock::now();
    const size_t most = place.guest->isAdmitted() ? kMaxFrameBytes : kMaxHelloBytes;
    if (place.frame->size() + length > most || !lws_frame_is_binary(connection)) {
        place.guest->refuse("This message makes no sense to the gateway; reload the page.", false);
    } else {
        place.frame->append(data, length);
        if (!lws_is_final_fragment(connection) || lws_remaining_packet_payload(connection) > 0) return 0;
        gateway.receive(*place.guest, *place.frame, now);
        place.frame->clear();
    }
    if (place.guest->isDue(now)) lws_callback_on_writable(connection);
    return 0;
}

int GatewayServer::Port::write(lws* connection, GuestConnection& place) {
    if (!place.guest) return -1;
    const auto now = Gateway::Clock::now();
    const std::string frame = place.guest->nextFrame(now);
    if (!frame.empty()) {
        std::vector<unsigned char> bytes(LWS_PRE + frame.size());
        std::memcpy(bytes.data() + LWS_PRE, frame.data(), frame.size());
        if (lws_write(connection, bytes.data() + LWS_PRE, frame.size(), LWS_WRITE_BINARY) < int(frame.size()))
            return -1;
    }
    if (place.guest->shouldClose(now)) {
        // From here on libwebsockets reads and drops what still comes, 5 s at most, until the guest has
        // closed, too: a socket closed before would reset the line, and the guest might lose what it was
        // told.
        guests.erase(connection);
        lws_close_reason(connection, LWS_CLOSE_STATUS_POLICY_VIOLATION, nullptr, 0);
        return -1;
    }
    if (place.guest->isDue(now)) lws_callback_on_writable(connection);
    return 0;
}

void GatewayServer::Port::step() {
    const auto now = Gateway::Clock::now();
    gateway.step(now);
    for (const auto& [connection, guest] : guests) {
        if (guest->shouldClose(now))
            kill(connection);
        else if (guest->isDue(now))
            lws_callback_on_writable(connection);
    }
}

GatewayServer::GatewayServer(const GatewayOptions& options) : port_(std::make_unique<Port>(options)) {}

GatewayServer::~GatewayServer() = default;

void GatewayServer::serveUntil(const std::function<bool()>& stop) {
    while (!stop())
        if (lws_service(port_->context, 0) < 0) throw std::runtime_error("the gateway's network has failed");
}

uint16_t GatewayServer::port() const {
    return uint16_t(lws_get_vhost_listen_port(port_->vhost));
}

const GatewayCertificate& GatewayServer::certificate() const {
    return port_->certificate;
}

bool GatewayServer::hasPage() const {
    return port_->pages.isBuilt();
}

}  // namespace bonemill::gateway
