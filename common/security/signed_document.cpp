#include "common/security/signed_document.h"

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/pkcs7.h>
#include <openssl/x509.h>

#include <memory>
#include <optional>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

using DocumentBio = std::unique_ptr<BIO, decltype(&BIO_free_all)>;

std::string contentOf(BIO* bio) {
    char* bytes = nullptr;
    const long count = BIO_get_mem_data(bio, &bytes);
    return {bytes, size_t(count)};
}

// Returns what stands between <tag> and </tag>, without spaces at the ends; empty if there is no such tag.
std::string fieldOf(const std::string& text, const std::string& tag) {
    const size_t begin = text.find("<" + tag + ">");
    const size_t end = text.find("</" + tag + ">");
    if (begin == std::string::npos || end == std::string::npos) return "";
    const size_t first = begin + tag.size() + 2;
    return end < first ? "" : text.substr(first, end - first);
}

std::optional<std::time_t> timeOf(const std::string& text) {
    std::tm parts{};
    const char* const rest = strptime(text.c_str(), "%Y-%m-%dT%H:%M:%S", &parts);
    if (!rest || std::string(rest) != "Z") return std::nullopt;  // not as make-session writes it
    return timegm(&parts);
}

}  // namespace

std::string signedText(const std::filesystem::path& file, const Certificate& authority) {
    const DocumentBio bio(BIO_new_file(file.c_str(), "r"), BIO_free_all);
    if (!bio) throw UserError(file.string() + " cannot be read");
    BIO* raw_content = nullptr;
    const std::unique_ptr<PKCS7, decltype(&PKCS7_free)> document(SMIME_read_PKCS7(bio.get(), &raw_content),
                                                                 PKCS7_free);
    const DocumentBio content(raw_content, BIO_free_all), text(BIO_new(BIO_s_mem()), BIO_free_all);
    const std::unique_ptr<STACK_OF(X509), void (*)(STACK_OF(X509)*)> signers(
        sk_X509_new_null(), [](STACK_OF(X509) * stack) { sk_X509_free(stack); });
    sk_X509_push(signers.get(), const_cast<X509*>(authority.get()));
    const bool is_signed =
        document && PKCS7_verify(document.get(), signers.get(), nullptr, content.get(), text.get(),
                                 PKCS7_TEXT | PKCS7_NOVERIFY | PKCS7_NOINTERN) == 1;
    ERR_clear_error();
    if (!is_signed) throw UserError(file.string() + " was not signed by this folder's permissions_ca.pem");
    return contentOf(text.get());
}

void requirePermissionsFor(const std::string& text, const Certificate& owner, std::time_t now) {
    const std::string subject = fieldOf(text, "subject_name");
    if (subject != owner.subject())
        throw UserError("permissions.p7s is for " + subject + ", but identity.pem for " + owner.subject());
    const auto first = timeOf(fieldOf(text, "not_before")), last = timeOf(fieldOf(text, "not_after"));
    if (first && last)
        requireBetween(now, *first, *last, "what " + owner.identity().name + " may do (permissions.p7s)");
}

}  // namespace bonemill
