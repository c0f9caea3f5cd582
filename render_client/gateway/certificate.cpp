#include "render_client/gateway/certificate.h"

#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>
#include <unistd.h>

#include <cstdio>
#include <memory>

#include "common/private_file.h"
#include "common/user_error.h"
#include "render_client/secrets/secrets.h"

namespace bonemill::gateway {
namespace {

using KeyPtr = std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)>;
using X509Ptr = std::unique_ptr<X509, decltype(&X509_free)>;
using BioPtr = std::unique_ptr<BIO, decltype(&BIO_free)>;
using FilePtr = std::unique_ptr<FILE, decltype(&std::fclose)>;

constexpr long kLifetime_s = 3650L * 86400;

[[noreturn]] void fail(const std::filesystem::path& file, const char* what) {
    throw UserError(file.string() + ": " + what);
}

// What `write` writes into memory.
template <class Write>
std::string pemOf(Write&& write) {
    const BioPtr memory(BIO_new(BIO_s_mem()), BIO_free);
    if (!memory || write(memory.get()) != 1) throw UserError("library: OpenSSL writes no PEM");
    char* bytes = nullptr;
    const long size = BIO_get_mem_data(memory.get(), &bytes);
    return {bytes, size_t(size)};
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
    fillRandom(&serial, sizeof serial);
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
    writePrivateFile(place.key, pemOf([&](BIO* memory) {
                         return PEM_write_bio_PrivateKey(memory, key.get(), nullptr, nullptr, 0, nullptr,
                                                         nullptr);
                     }));
    writePrivateFile(place.certificate,
                     pemOf([&](BIO* memory) { return PEM_write_bio_X509(memory, certificate.get()); }));
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
    if (!std::filesystem::exists(certificate.certificate) || !std::filesystem::exists(certificate.key))
        make(certificate);
    certificate.fingerprint = fingerprintOf(certificate.certificate);
    return certificate;
}

}  // namespace bonemill::gateway
