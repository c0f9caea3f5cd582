#include "common/security/certificate.h"

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>

#include <charconv>
#include <string_view>
#include <utility>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

using Bio = std::unique_ptr<BIO, decltype(&BIO_free)>;

Bio openPem(const std::filesystem::path& file) {
    Bio bio(BIO_new_file(file.c_str(), "r"), BIO_free);
    if (!bio) throw UserError(file.string() + " cannot be read");
    return bio;
}

std::string entryOf(const X509_NAME* subject, int kind) {
    char text[256] = "";
    X509_NAME_get_text_by_NID(const_cast<X509_NAME*>(subject), kind, text, sizeof text);
    return text;
}

// DDS Security 1.1, 9.3.3: one bit that is set, then the first 47 bits of the subject's hash.
GuidPrefix prefixOf(const X509_NAME* subject) {
    const unsigned char* bytes = nullptr;
    size_t count = 0;
    std::array<unsigned char, EVP_MAX_MD_SIZE> hash{};
    GuidPrefix prefix{};
    if (X509_NAME_get0_der(subject, &bytes, &count) != 1 ||
        EVP_Digest(bytes, count, hash.data(), nullptr, EVP_sha256(), nullptr) != 1)
        throw UserError("a certificate's subject cannot be read");
    prefix[0] = uint8_t(0x80 | hash[0] >> 1);
    for (size_t i = 1; i < prefix.size(); ++i) prefix[i] = uint8_t(hash[i - 1] << 7 | hash[i] >> 1);
    return prefix;
}

std::optional<uint32_t> sessionOf(const std::string& organisation) {
    constexpr std::string_view kBefore = "bonemill-session-";
    if (!organisation.starts_with(kBefore)) return std::nullopt;
    uint32_t number = 0;
    const char *const begin = organisation.data() + kBefore.size(), *const end = organisation.data() +
                                                                                 organisation.size();
    const auto [rest, error] = std::from_chars(begin, end, number);
    return error == std::errc{} && rest == end ? std::optional(number) : std::nullopt;
}

std::time_t unixTimeOf(const ASN1_TIME* time) {
    std::tm parts{};
    return ASN1_TIME_to_tm(time, &parts) == 1 ? timegm(&parts) : 0;
}

}  // namespace

Certificate::Certificate(x509_st* owned) : x509_(owned, X509_free) {
    const X509_NAME* const subject = X509_get_subject_name(owned);
    identity_ = {entryOf(subject, NID_commonName), entryOf(subject, NID_organizationalUnitName),
                 prefixOf(subject), sessionOf(entryOf(subject, NID_organizationName))};
}

std::vector<Certificate> Certificate::readAll(const std::filesystem::path& file) {
    const Bio bio = openPem(file);
    std::vector<Certificate> all;
    while (X509* const x509 = PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr))
        all.push_back(Certificate(x509));
    ERR_clear_error();
    if (all.empty()) throw UserError(file.string() + " holds no certificate");
    return all;
}

std::string Certificate::subject() const {
    const Bio text(BIO_new(BIO_s_mem()), BIO_free);
    X509_NAME_print_ex(text.get(), X509_get_subject_name(x509_.get()), 0, XN_FLAG_SEP_COMMA_PLUS);
    char* bytes = nullptr;
    const long count = BIO_get_mem_data(text.get(), &bytes);
    return {bytes, size_t(count)};
}

bool Certificate::isIssuedBy(const Certificate& authority) const {
    X509* const issuer = authority.x509_.get();
    const bool is_issued = X509_check_issued(issuer, x509_.get()) == X509_V_OK &&
                           X509_verify(x509_.get(), X509_get0_pubkey(issuer)) == 1;
    ERR_clear_error();
    return is_issued;
}

std::time_t Certificate::validFrom() const {
    return unixTimeOf(X509_get0_notBefore(x509_.get()));
}

std::time_t Certificate::validUntil() const {
    return unixTimeOf(X509_get0_notAfter(x509_.get()));
}

void Certificate::requireValidAt(std::time_t now) const {
    requireBetween(now, validFrom(), validUntil(), "the certificate of " + identity_.name);
}

bool Certificate::hasKey(const std::filesystem::path& file) const {
    const Bio bio = openPem(file);
    // Who has set a password types it nowhere: such a key counts as none.
    const std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)> key(
        PEM_read_bio_PrivateKey(
            bio.get(), nullptr, [](char*, int, int, void*) { return -1; }, nullptr),
        EVP_PKEY_free);
    if (!key) {
        ERR_clear_error();
        throw UserError(file.string() + " holds no private key without a password");
    }
    return EVP_PKEY_eq(key.get(), X509_get0_pubkey(x509_.get())) == 1;
}

std::string dayText(std::time_t time) {
    std::tm parts{};
    gmtime_r(&time, &parts);
    char text[64] = "";
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &parts);
    return text;
}

void requireBetween(std::time_t now, std::time_t first, std::time_t last, const std::string& what,
                    const std::string& remedy) {
    if (now < first)
        throw UserError(what + " is not valid before " + dayText(first) + ", and this PC's clock says " +
                        dayText(now));
    if (now > last)
        throw UserError(what + " expired on " + dayText(last) + ", and this PC's clock says " + dayText(now) +
                        ": " + remedy);
}

}  // namespace bonemill
