#include "render_client/web/gateway/host_names.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <openssl/x509v3.h>

#include <algorithm>
#include <cctype>
#include <utility>

namespace bonemill::gateway {
namespace {

constexpr std::string_view kScheme = "https://", kDefaultPort = ":443";

std::string lowered(std::string_view text) {
    std::string low(text);
    for (char& c : low) c = char(std::tolower(static_cast<unsigned char>(c)));
    return low;
}

// Without its port, brackets, and the dot that ends a whole name.
std::string nameOf(std::string_view host) {
    if (host.starts_with('[') && host.find(']') != host.npos)
        return std::string(host.substr(1, host.find(']') - 1));
    std::string name = lowered(host.substr(0, host.find(':')));
    if (name.ends_with('.')) name.pop_back();
    return name;
}

bool isAddress(const std::string& name) {
    in6_addr address{};
    return inet_pton(AF_INET, name.c_str(), &address) == 1 ||
           inet_pton(AF_INET6, name.c_str(), &address) == 1;
}

std::string withoutDefaultPort(std::string_view host) {
    std::string low = lowered(host);
    if (low.ends_with(kDefaultPort)) low.resize(low.size() - kDefaultPort.size());
    return low;
}

}  // namespace

HostNames::HostNames(const GatewayCertificate& certificate, const std::vector<std::string>& others) {
    for (const std::string& name : others) others_.push_back(nameOf(name));
    if (!certificate.is_self_made) certificate_.push_back(Certificate::read(certificate.certificate));
}

bool HostNames::isOwn(std::string_view host) const {
    if (certificate_.empty()) return true;
    const std::string name = nameOf(host);
    if (name == "localhost" || isAddress(name) || std::ranges::find(others_, name) != others_.end())
        return true;
    X509* const shown = const_cast<X509*>(certificate_.front().get());  // OpenSSL only reads it
    return X509_check_host(shown, name.data(), name.size(), 0, nullptr) == 1;
}

bool isSameOrigin(std::string_view origin, std::string_view host) {
    return lowered(origin.substr(0, kScheme.size())) == kScheme &&
           withoutDefaultPort(origin.substr(kScheme.size())) == withoutDefaultPort(host);
}

}  // namespace bonemill::gateway
