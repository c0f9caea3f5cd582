#include "render_client/web/connect/tls_socket.h"

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>
#include <poll.h>

#include <algorithm>
#include <cctype>
#include <csignal>
#include <utility>

#include "common/base/user_error.h"
#include "render_client/web/secrets/secrets.h"
#include "render_client/web/tcp/dial.h"

namespace bonemill::connect {
namespace {

using Clock = std::chrono::steady_clock;

std::string placeOf(const TlsTarget& target) {
    return target.host + ":" + std::to_string(target.port);
}

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
    return hexOf({hash, length});
}

std::string digitsOf(const std::string& fingerprint) {
    std::string digits;
    for (const char c : fingerprint)
        if (std::isxdigit(static_cast<unsigned char>(c)))
            digits += char(std::tolower(static_cast<unsigned char>(c)));
    return digits;
}

}  // namespace

struct TlsSocket::State {
    ~State() {
        if (ssl) {
            SSL_shutdown(ssl);
            SSL_free(ssl);
        }
        if (context) SSL_CTX_free(context);
    }
    void shakeHands(const TlsTarget& target, Clock::time_point end);
    void prove(const TlsTarget& target) const;
    long moved(int result);

    Descriptor socket;
    SSL_CTX* context = nullptr;
    SSL* ssl = nullptr;
    bool wants_to_write = false;  // TLS itself
};

void TlsSocket::State::shakeHands(const TlsTarget& target, Clock::time_point end) {
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
    for (int result = SSL_connect(ssl); result != 1; result = SSL_connect(ssl)) {
        const int error = SSL_get_error(ssl, result);
        const short events = error == SSL_ERROR_WANT_READ    ? POLLIN
                             : error == SSL_ERROR_WANT_WRITE ? POLLOUT
                                                             : 0;
        if (events == 0 || !waitFor(socket.get(), events, end))
            throw UserError("--connect " + placeOf(target) + ": nobody speaks TLS there");
    }
}

void TlsSocket::State::prove(const TlsTarget& target) const {
    const std::string shown = fingerprintOf(ssl), expected = digitsOf(target.fingerprint);
    if (!expected.empty() && shown != expected)
        throw UserError("--connect " + placeOf(target) +
                        ": has another certificate than --fingerprint says: " + shown);
    if (expected.empty() && (shown.empty() || SSL_get_verify_result(ssl) != X509_V_OK))
        throw UserError(
            "--connect " + placeOf(target) +
            ": no authority that this PC trusts knows the certificate. If the gateway itself printed "
            "this fingerprint, add --fingerprint " +
            shown);
}

// The error queue is the thread's: what is old must not be taken for new.
long TlsSocket::State::moved(int result) {
    if (result > 0) return result;
    const int error = SSL_get_error(ssl, result);
    ERR_clear_error();
    wants_to_write = error == SSL_ERROR_WANT_WRITE;
    return wants_to_write || error == SSL_ERROR_WANT_READ ? 0 : -1;
}

TlsSocket::TlsSocket(const TlsTarget& target, std::chrono::milliseconds patience)
    : state_(std::make_unique<State>()) {
    std::signal(SIGPIPE, SIG_IGN);  // OpenSSL writes into sockets that may be closed
    const auto end = Clock::now() + patience;
    Dialled dialled = dial(target.host, target.port, patience);
    if (!dialled.socket) throw UserError("--connect " + placeOf(target) + ": " + dialled.problem);
    state_->socket = std::move(dialled.socket);
    state_->shakeHands(target, end);
    state_->prove(target);
}

TlsSocket::~TlsSocket() = default;

long TlsSocket::read(char* bytes, size_t most) {
    return state_->moved(SSL_read(state_->ssl, bytes, int(most)));
}

long TlsSocket::write(const char* bytes, size_t size) {
    return size == 0 ? 0 : state_->moved(SSL_write(state_->ssl, bytes, int(size)));
}

void TlsSocket::wait(bool wants_to_write, int wake, std::chrono::milliseconds patience) {
    if (SSL_pending(state_->ssl) > 0) return;
    const short out = wants_to_write || state_->wants_to_write ? POLLOUT : 0;
    pollfd looks[] = {{state_->socket.get(), short(POLLIN | out), 0}, {wake, POLLIN, 0}};
    poll(looks, 2, int(patience.count()));
}

int TlsSocket::descriptor() const {
    return state_->socket.get();
}

}  // namespace bonemill::connect
