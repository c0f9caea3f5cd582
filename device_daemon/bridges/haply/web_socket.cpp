#include "device_daemon/bridges/haply/web_socket.h"

#include <libwebsockets.h>
#include <poll.h>

#include <algorithm>
#include <deque>
#include <vector>

#include "common/base/user_error.h"
#include "common/rt/clock.h"

namespace bonemill::bridge {
namespace {

constexpr int64_t kConnectNs = 3 * kNsPerSecond;
constexpr int64_t kSendNs = 20 * kNsPerMillisecond;
constexpr size_t kLargestMessage = 1 << 20;  // bytes; the whole inventory has a few thousand

constexpr int64_t kLookEveryNs = kNsPerMillisecond;  // while it connects, its socket may become another
constexpr int kWithoutWaiting = -1;

}  // namespace

struct WebSocket::Connection {
    static int onEvent(lws* socket, lws_callback_reasons reason, void* user, void* data, size_t length);

    ~Connection() {
        if (context) lws_context_destroy(context);
    }
    // Serves the socket until the condition holds, the deadline passes or the connection has ended.
    template <class Condition>
    bool serveUntil(const Condition& condition, int64_t deadline_ns);
    void waitForSocket(int64_t longest_ns);
    void take(const char* data, size_t length, bool is_last);
    bool write();

    lws_context* context = nullptr;
    lws* socket = nullptr;
    bool is_open = false;
    bool has_ended = false;
    std::string reason;
    std::vector<unsigned char>
        outgoing;  // with the room that libwebsockets wants in front; empty: nothing to send
    std::string partial;
    std::deque<std::string> arrived;
};

int WebSocket::Connection::onEvent(lws* socket, lws_callback_reasons reason, void*, void* data,
                                   size_t length) {
    auto* self = static_cast<Connection*>(lws_context_user(lws_get_context(socket)));
    switch (reason) {
        case LWS_CALLBACK_CLIENT_ESTABLISHED:
            self->is_open = true;
            break;
        case LWS_CALLBACK_CLIENT_CONNECTION_ERROR:
            self->reason = data ? std::string(static_cast<const char*>(data), length) : "";
            self->has_ended = true;
            break;
        case LWS_CALLBACK_CLIENT_CLOSED:
            self->is_open = false;
            self->has_ended = true;
            break;
        case LWS_CALLBACK_CLIENT_RECEIVE:
            self->take(static_cast<const char*>(data), length,
                       lws_is_final_fragment(socket) && lws_remaining_packet_payload(socket) == 0);
            break;
        case LWS_CALLBACK_CLIENT_WRITEABLE:
            return self->write() ? 0 : -1;
        default:
            break;
    }
    return 0;
}

// libwebsockets has no wait that ends at an instant of ours: it is asked for what can be done without
// waiting, and the waiting is done here.
template <class Condition>
bool WebSocket::Connection::serveUntil(const Condition& condition, int64_t deadline_ns) {
    while (!condition()) {
        const int64_t left_ns = deadline_ns - monotonicNowNs();
        if (has_ended || left_ns <= 0) return false;
        lws_service(context, kWithoutWaiting);
        if (!condition() && !has_ended) waitForSocket(std::min(left_ns, is_open ? left_ns : kLookEveryNs));
    }
    return true;
}

void WebSocket::Connection::waitForSocket(int64_t longest_ns) {
    const bool wants_to_write = !is_open || !outgoing.empty();
    pollfd descriptor{socket ? int(lws_get_socket_fd(socket)) : -1,
                      short(POLLIN | (wants_to_write ? POLLOUT : 0)), 0};
    const timespec limit = timespecOfNs(longest_ns);
    ppoll(&descriptor, 1, &limit, nullptr);
}

void WebSocket::Connection::take(const char* data, size_t length, bool is_last) {
    if (partial.size() + length <= kLargestMessage) partial.append(data, length);
    if (!is_last) return;
    arrived.push_back(std::move(partial));
    partial.clear();
}

bool WebSocket::Connection::write() {
    if (outgoing.empty()) return true;
    const size_t length = outgoing.size() - LWS_PRE;
    const int written = lws_write(socket, outgoing.data() + LWS_PRE, length, LWS_WRITE_TEXT);
    outgoing.clear();
    return written >= int(length);
}

WebSocket::WebSocket(const std::string& host, uint16_t port) : connection_(std::make_unique<Connection>()) {
    lws_set_log_level(0, nullptr);
    static const lws_protocols kProtocols[] = {{"bonemill", Connection::onEvent, 0, 65536, 0, nullptr, 0},
                                               {nullptr, nullptr, 0, 0, 0, nullptr, 0}};
    lws_context_creation_info info{};
    info.port = CONTEXT_PORT_NO_LISTEN;
    info.protocols = kProtocols;
    info.user = connection_.get();
    connection_->context = lws_create_context(&info);
    if (!connection_->context) throw UserError("library: libwebsockets gives no context");
    lws_client_connect_info connect{};
    connect.context = connection_->context;
    connect.address = host.c_str();
    connect.host = host.c_str();
    connect.port = port;
    connect.path = "/";
    connect.local_protocol_name = "bonemill";
    connect.pwsi = &connection_->socket;
    lws_client_connect_via_info(&connect);
    connection_->serveUntil([this] { return connection_->is_open; }, monotonicNowNs() + kConnectNs);
    if (!isOpen())
        throw UserError("no WebSocket at " + host + ":" + std::to_string(port) +
                        (connection_->reason.empty() ? "" : " (" + connection_->reason + ")"));
}

WebSocket::~WebSocket() = default;

bool WebSocket::isOpen() const noexcept {
    return connection_->is_open;
}

bool WebSocket::send(const std::string& message) {
    if (!isOpen()) return false;
    connection_->outgoing.assign(LWS_PRE, 0);
    connection_->outgoing.insert(connection_->outgoing.end(), message.begin(), message.end());
    lws_callback_on_writable(connection_->socket);
    return connection_->serveUntil([this] { return connection_->outgoing.empty(); },
                                   monotonicNowNs() + kSendNs);
}

bool WebSocket::receive(std::string& message, int64_t deadline_ns) {
    connection_->serveUntil([this] { return !connection_->arrived.empty(); }, deadline_ns);
    if (connection_->arrived.empty()) return false;
    message = std::move(connection_->arrived.front());
    connection_->arrived.pop_front();
    return true;
}

}  // namespace bonemill::bridge
