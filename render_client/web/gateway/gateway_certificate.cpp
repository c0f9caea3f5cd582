#include "render_client/web/gateway/gateway_certificate.h"

#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>
#include <unistd.h>

#include <array>
#include <memory>

#include "common/base/user_error.h"
#include "common/files/require_private.h"
#include "common/files/whole_file.h"
#include "common/secrets/secrets.h"
#include "common/security/certificate.h"

namespace bonemill::gateway {
namespace {

using KeyPtr = std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)>;
using X509Ptr = std::unique_ptr<X509, decltype(&X509_free)>;
using BioPtr = std::unique_ptr<BIO, decltype(&BIO_free)>;

constexpr long kLifetime_s = 3650L * 86400;

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

void make(const GatewayCertificate& place) {
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

std::string fingerprintOf(const Certificate& certificate) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> hash{};
    unsigned length = 0;
    if (X509_digest(certificate.get(), EVP_sha256(), hash.data(), &length) != 1)
        throw UserError("library: OpenSSL makes no fingerprint");
    return hexOf({hash.data(), length});
}

// What is wrong here guests would be told, and could not mend.
GatewayCertificate checked(GatewayCertificate place, std::time_t now, const std::string& remedy) {
    const auto shown = Certificate::read(place.certificate);
    if (!shown.hasKey(place.key))
        throw UserError(place.key.string() + ": is not the key of " + place.certificate.string() + "; " +
                        remedy);
    requirePrivate(place.key, "600");
    requireBetween(now, shown.validFrom(), shown.validUntil(), place.certificate.string(), remedy);
    place.fingerprint = fingerprintOf(shown);
    return place;
}

}  // namespace

GatewayCertificate certificateOf(const std::filesystem::path& certificate, const std::filesystem::path& key,
                                 std::time_t now) {
    return checked({certificate, key, "", false}, now, "give the gateway another --certificate and --key");
}

GatewayCertificate selfMadeCertificate(const std::filesystem::path& folder, std::time_t now) {
    const GatewayCertificate place{folder / "gateway-certificate.pem", folder / "gateway-key.pem", "", true};
    if (!std::filesystem::exists(place.certificate) || !std::filesystem::exists(place.key)) make(place);
    return checked(place, now, "delete it, and the gateway makes another one");
}

}  // namespace bonemill::gateway
