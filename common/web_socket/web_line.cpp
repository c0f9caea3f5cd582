#include "common/web_socket/web_line.h"

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <utility>

#include "common/base/user_error.h"
#include "common/digest/digest.h"
#include "common/rt/clock.h"
#include "common/tcp/dial.h"

namespace bonemill {
namespace {

using Clock = std::chrono::steady_clock;

int leftMs(Clock::time_point end) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count();
    return int(std::max<int64_t>(left, 0));
}

bool waitFor(int socket, short events, Clock::time_point end) {
    pollfd look{socket, events, 0};
    return poll(&look, 1, leftMs(end)) > 0;
}

std::string fingerprintOf(SSL* ssl) {
    X509* const certificate = SSL_get0_peer_certificate(ssl);
    unsigned char hash[EVP_MAX_MD_SIZE];
    unsigned length = 0;
    if (!certificate || X509_digest(certificate, EVP_sha256(), hash, &length) != 1) return "";
    return hexOf({reinterpret_cast<const char*>(hash), length});
}

std::string digitsOf(const std::string& fingerprint) {
    std::string digits;
    for (const char c : fingerprint)
        if (std::isxdigit(static_cast<unsigned char>(c)))
            digits += char(std::tolower(static_cast<unsigned char>(c)));
    return digits;
}

}  // namespace

struct WebLine::State {
    ~State() {
        if (ssl) {
            SSL_shutdown(ssl);
            SSL_free(ssl);
        }
        if (context) SSL_CTX_free(context);
    }
    void shakeHands(const WebTarget& target, Clock::time_point end);
    void prove(const WebTarget& target) const;
    long moved(long result);

    Descriptor socket;
    SSL_CTX* context = nullptr;
    SSL* ssl = nullptr;
    bool wants_to_write = false;  // TLS itself
};

void WebLine::State::shakeHands(const WebTarget& target, Clock::time_point end) {
    context = SSL_CTX_new(TLS_client_method());
    if (!context) throw UserError("library: OpenSSL gives no context");
    SSL_CTX_set_min_proto_version(context, TLS1_2_VERSION);
    if (target.fingerprint.empty()) SSL_CTX_set_default_verify_paths(context);
    SSL_CTX_set_mode(context, SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
    ssl = SSL_new(context);
    if (!ssl) throw UserError("library: OpenSSL gives no connection");
    SSL_set_fd(ssl, socket.get());
    // The certificate is judged behind the handshake, so that the user learns its fingerprint.
    SSL_set_verify(ssl, SSL_VERIFY_NONE, nullptr);
    if (X509_VERIFY_PARAM_set1_ip_asc(SSL_get0_param(ssl), target.host.c_str()) != 1) {
        SSL_set1_host(ssl, target.host.c_str());
        SSL_set_tlsext_host_name(ssl, target.host.c_str());
    }
    ERR_clear_error();  // the queue is the thread's: what others left must not be taken for this line's
    for (int result = SSL_connect(ssl); result != 1; result = SSL_connect(ssl)) {
        const int error = SSL_get_error(ssl, result);
        const short events = error == SSL_ERROR_WANT_READ    ? POLLIN
                             : error == SSL_ERROR_WANT_WRITE ? POLLOUT
                                                             : 0;
        if (events == 0 || !waitFor(socket.get(), events, end))
            throw UserError(target.place() + ": nobody speaks TLS there");
    }
}

void WebLine::State::prove(const WebTarget& target) const {
    const std::string shown = fingerprintOf(ssl), expected = digitsOf(target.fingerprint);
    if (!expected.empty() && shown != expected)
        throw UserError(target.place() + ": has another certificate than --fingerprint says: " + shown);
    if (expected.empty() && (shown.empty() || SSL_get_verify_result(ssl) != X509_V_OK))
        throw UserError(
            target.place() +
            ": no authority that this PC trusts knows the certificate. If the gateway itself printed "
            "this fingerprint, add --fingerprint " +
            shown);
}

long WebLine::State::moved(long result) {
    if (result > 0) return result;
    if (!ssl) return result < 0 && (errno == EAGAIN || errno == EINTR) ? 0 : -1;
    const int error = SSL_get_error(ssl, int(result));
    wants_to_write = error == SSL_ERROR_WANT_WRITE;
    return wants_to_write || error == SSL_ERROR_WANT_READ ? 0 : -1;
}

WebLine::WebLine(const WebTarget& target, std::chrono::milliseconds patience)
    : state_(std::make_unique<State>()) {
    std::signal(SIGPIPE, SIG_IGN);  // OpenSSL writes into sockets that may be closed
    const auto end = Clock::now() + patience;
    Dialled dialled = dial(target.host, target.port, patience);
    if (!dialled.socket) throw UserError(target.place() + ": " + dialled.problem);
    state_->socket = std::move(dialled.socket);
    if (target.is_plain) return;
    state_->shakeHands(target, end);
    state_->prove(target);
}

WebLine::~WebLine() = default;

long WebLine::read(char* bytes, size_t most) {
    SSL* const ssl = state_->ssl;
    ERR_clear_error();  // as above
    return state_->moved(ssl ? SSL_read(ssl, bytes, int(most)) : recv(state_->socket.get(), bytes, most, 0));
}

long WebLine::write(const char* bytes, size_t size) {
    if (size == 0) return 0;
    SSL* const ssl = state_->ssl;
    ERR_clear_error();
    return state_->moved(ssl ? SSL_write(ssl, bytes, int(size))
                             : send(state_->socket.get(), bytes, size, MSG_NOSIGNAL));
}

void WebLine::wait(bool wants_to_write, int wake, std::chrono::nanoseconds patience) {
    if (state_->ssl && SSL_pending(state_->ssl) > 0) return;
    const short out = wants_to_write || state_->wants_to_write ? POLLOUT : 0;
    pollfd looks[] = {{state_->socket.get(), short(POLLIN | out), 0}, {wake, POLLIN, 0}};
    const timespec limit = timespecOfNs(std::max<int64_t>(patience.count(), 0));
    ppoll(looks, 2, &limit, nullptr);
}

}  // namespace bonemill
