// The names by which browsers may reach this gateway, and the origin of its own page. Any thread.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/security/certificate.h"
#include "render_client/web/gateway/gateway_certificate.h"

namespace bonemill::gateway {

class HostNames {
  public:
    // Those of the certificate, and `others`. A certificate of the gateway's own making says nothing about
    // the names that a laboratory's network has for this PC: then every name is taken for one of them.
    HostNames(const GatewayCertificate& certificate, const std::vector<std::string>& others);

    // `host` is as a request has it: "lab-pc", "lab-pc:8443", "[::1]:8443". Addresses and localhost are
    // always its own: no page of elsewhere can be reached by them.
    bool isOwn(std::string_view host) const;

  private:
    std::vector<Certificate> certificate_;  // or none
    std::vector<std::string> others_;       // in small letters
};

// Returns whether a page of this origin ("https://lab-pc") comes from where a request was sent
// ("lab-pc:443"): a port that is not named is that of HTTPS.
bool isSameOrigin(std::string_view origin, std::string_view host);

}  // namespace bonemill::gateway
