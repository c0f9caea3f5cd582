#include "render_client/web/relay/relay_greeting.h"

#include <openssl/evp.h>
#include <openssl/hmac.h>

#include <stdexcept>

namespace bonemill {

std::string greetingOf(RelayAsk ask, const GuestId& guest) {
    std::string greeting(kRelayMagic);
    greeting += static_cast<char>(ask);
    greeting.append(guest.data(), guest.size());
    return greeting;
}

RelayProof proofOf(std::string_view secret, std::string_view greeting, const RelayNonce& nonce) {
    std::string said(greeting);
    said.append(nonce.data(), nonce.size());
    RelayProof proof{};
    unsigned size = 0;
    if (HMAC(EVP_sha256(), secret.data(), int(secret.size()),
             reinterpret_cast<const unsigned char*>(said.data()), said.size(),
             reinterpret_cast<unsigned char*>(proof.data()), &size) == nullptr)
        throw std::runtime_error("HMAC-SHA256 failed");
    return proof;
}

}  // namespace bonemill
