#include "render_client/gateway/certificate.h"

#include <fcntl.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <memory>

#include "common/user_error.h"
#include "render_client/gateway/secrets.h"

namespace bonemill::gateway {
namespace {

using KeyPtr = std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)>;
using X509Ptr = std::unique_ptr<X509, decltype(&X509_free)>;
using FilePtr = std::unique_ptr<FILE, decltype(&std::fclose)>;

constexpr long kLifetime_s = 3650L * 86400;

[[noreturn]] void fail(const std::filesystem::path& file, const char* what) {
    throw UserError(file.string() + ": " + what);
}

FilePtr privateFile(const std::filesystem::path& path) {
    const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (file < 0) fail(path, "cannot be written");
    fchmod(file, 0600);
    return {fdopen(file, "w"), std::fclose};
}

void addExtension(X509* certificate, int kind, const std::string& value) {
    X509V3_CTX context;
    X509V3_set_ctx(&context, certificate, certificate, nullptr, nullptr, 0);
    X509_EXTENSION* const extension = X509V3_EXT_conf_nid(nullptr, &context, kind, value.c_str());
    if (!extension) return;  // a host's name that no certificate can have
    X509_add_ext(certificate, extension, -1);
    X509_EXTENSION_free(extension);
}

X509Ptr signedBy(EVP_PKEY* key) {
    X509Ptr certificate(X509_new(), X509_free);
    uint64_t serial = 0;
    RAND_bytes(reinterpret_cast<unsigned char*>(&serial), sizeof serial);
    X509_set_version(certificate.get(), 2);
    ASN1_INTEGER_set_uint64(X509_get_serialNumber(certificate.get()), serial >> 1);
    X509_gmtime_adj(X509_getm_notBefore(certificate.get()), -86400);  // clocks differ
    X509_gmtime_adj(X509_getm_notAfter(certificate.get()), kLifetime_s);
    X509_set_pubkey(certificate.get(), key);
    char host[256] = "localhost";
    gethostname(host, sizeof host - 1);
    X509_NAME* const name = X509_get_subject_name(certificate.get());
    X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_UTF8,
                               reinterpret_cast<const unsigned char*>("bonemill gateway"), -1, -1, 0);
    X509_set_issuer_name(certificate.get(), name);
    addExtension(certificate.get(), NID_subject_alt_name,
                 std::string("DNS:localhost,IP:127.0.0.1,IP:::1,DNS:") + host);
    addExtension(certificate.get(), NID_basic_constraints, "critical,CA:FALSE");
    addExtension(certificate.get(), NID_ext_key_usage, "serverAuth");
    if (X509_sign(certificate.get(), key, EVP_sha256()) == 0)
        throw UserError("library: OpenSSL signs no certificate");
    return certificate;
}

void make(const Certificate& place) {
    const KeyPtr key(EVP_EC_gen("P-256"), EVP_PKEY_free);
    if (!key) throw UserError("library: OpenSSL makes no key");
    const X509Ptr certificate = signedBy(key.get());
    const FilePtr key_file = privateFile(place.key), certificate_file = privateFile(place.certificate);
    if (PEM_write_PrivateKey(key_file.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) != 1 ||
        PEM_write_X509(certificate_file.get(), certificate.get()) != 1)
        fail(place.key, "cannot be written");
}

std::string fingerprintOf(const std::filesystem::path& file) {
    const FilePtr stream(std::fopen(file.c_str(), "re"), std::fclose);
    if (!stream) fail(file, "cannot be read");
    const X509Ptr certificate(PEM_read_X509(stream.get(), nullptr, nullptr, nullptr), X509_free);
    if (!certificate) fail(file, "is no certificate in PEM");
    unsigned char* der = nullptr;
    const int size = i2d_X509(certificate.get(), &der);
    if (size <= 0) fail(file, "is no certificate in PEM");
    const std::string fingerprint = sha256Hex({reinterpret_cast<const char*>(der), size_t(size)});
    OPENSSL_free(der);
    return fingerprint;
}

}  // namespace

Certificate certificateOf(const std::filesystem::path& certificate, const std::filesystem::path& key) {
    if (access(key.c_str(), R_OK) != 0) fail(key, "cannot be read");
    return {certificate, key, fingerprintOf(certificate), false};
}

Certificate selfMadeCertificate(const std::filesystem::path& folder) {
    Certificate certificate{folder / "gateway-certificate.pem", folder / "gateway-key.pem", "", true};
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) fail(folder, error.message().c_str());
    if (!std::filesystem::exists(certificate.certificate) || !std::filesystem::exists(certificate.key))
        make(certificate);
    certificate.fingerprint = fingerprintOf(certificate.certificate);
    return certificate;
}

}  // namespace bonemill::gateway
