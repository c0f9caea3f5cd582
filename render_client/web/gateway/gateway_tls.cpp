#include "render_client/web/gateway/gateway_tls.h"

#include <openssl/ssl.h>

#include "common/base/user_error.h"

namespace bonemill::gateway {
namespace {

constexpr char kSuitesOf12[] = "ECDHE+AESGCM:ECDHE+CHACHA20";
constexpr unsigned char kProtocols[] = "\x08http/1.1";

int choose(SSL*, const unsigned char** chosen, unsigned char* length, const unsigned char* offered,
           unsigned offered_length, void*) {
    unsigned char* found = nullptr;
    const int result =
        SSL_select_next_proto(&found, length, kProtocols, sizeof kProtocols - 1, offered, offered_length);
    *chosen = found;
    return result == OPENSSL_NPN_NEGOTIATED ? SSL_TLSEXT_ERR_OK : SSL_TLSEXT_ERR_NOACK;
}

}  // namespace

boost::asio::ssl::context tlsOf(const GatewayCertificate& certificate) {
    boost::asio::ssl::context context(boost::asio::ssl::context::tls_server);
    SSL_CTX* const native = context.native_handle();
    SSL_CTX_set_options(native, SSL_OP_NO_RENEGOTIATION | SSL_OP_CIPHER_SERVER_PREFERENCE);
    SSL_CTX_set_mode(native, SSL_MODE_RELEASE_BUFFERS);
    SSL_CTX_set_alpn_select_cb(native, choose, nullptr);
    if (SSL_CTX_set_min_proto_version(native, TLS1_2_VERSION) != 1 ||
        SSL_CTX_set_cipher_list(native, kSuitesOf12) != 1)
        throw UserError("library: OpenSSL has no TLS 1.2");
    if (SSL_CTX_use_certificate_chain_file(native, certificate.certificate.c_str()) != 1)
        throw UserError(certificate.certificate.string() + ": TLS takes no certificate of it");
    if (SSL_CTX_use_PrivateKey_file(native, certificate.key.c_str(), SSL_FILETYPE_PEM) != 1)
        throw UserError(certificate.key.string() + ": TLS takes no key of it");
    return context;
}

}  // namespace bonemill::gateway
