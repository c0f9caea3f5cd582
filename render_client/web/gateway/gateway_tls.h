// How the gateway's port speaks TLS: 1.3, and of 1.2 the suites that authenticate what they encipher (AEAD).
#pragma once

#include <boost/asio/ssl/context.hpp>

#include "render_client/web/gateway/gateway_certificate.h"

namespace bonemill::gateway {

// Throws UserError.
boost::asio::ssl::context tlsOf(const GatewayCertificate& certificate);

}  // namespace bonemill::gateway
