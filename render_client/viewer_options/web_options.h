// Options of render_client that have to do with gateways: to be one (--serve), to be or use a relay (--relay,
// --via), to reach a session through one (--connect). docs/howto/gateway.md says how they meet.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/web_socket/web_line.h"
#include "render_client/web/gateway/gateway_options.h"
#include "render_client/web/relay/relay_greeting.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace bonemill {

// Host and port on a command line.
struct NetworkPlace {
    std::string host;
    uint16_t port = 0;
};

// Reads "0.0.0.0:8443" and "[::1]:8443", and "8443" alone where there is a host to assume. `option` has the
// text and is named in the message. Throws UserError.
NetworkPlace placeOf(const std::string& option, const std::string& text,
                     const std::string& assumed_host = {});
// Returns it as placeOf() reads it.
std::string textOf(const NetworkPlace& place);

struct RawRelay {
    std::optional<std::string> place;  // [ADDRESS:]PORT
    std::optional<std::string> via;    // HOST:PORT
    std::string secret_file;
};

// Returns the option that asks for a relay, which excludes `others`; --via needs `serve`. `raw` must outlive
// the parsing.
CLI::Option* addRelayOptions(CLI::App& app, RawRelay& raw, CLI::Option* serve,
                             const std::vector<CLI::Option*>& others);
// Return nothing where none is asked for. They read the secret. Throw UserError.
std::optional<RelayOptions> relayOptions(const RawRelay& raw);
std::optional<RelayPlace> relayPlace(const RawRelay& raw);

struct RawServe {
    std::optional<std::string> place;  // [ADDRESS:]PORT
    gateway::GatewayOptions options;
};

// Excludes what only viewers have; returns the option that asks for a gateway. `raw` must outlive the
// parsing.
CLI::Option* addServeOptions(CLI::App& app, RawServe& raw, const std::vector<CLI::Option*>& viewer_options);
// Returns nothing where no gateway is asked for. Throws UserError.
std::optional<gateway::GatewayOptions> serveOptions(const RawServe& raw);

struct ConnectOptions {
    WebTarget target;
    std::string token;
};

struct RawConnect {
    std::optional<std::string> link;
    std::string fingerprint;
    std::filesystem::path token_file;
};

// Excludes what is of DDS alone, or no viewer. `raw` must outlive the parsing.
void addConnectOptions(CLI::App& app, RawConnect& raw, const std::vector<CLI::Option*>& others);
// Returns nothing where no gateway is named. The token is the link's, the file's, or $BONEMILL_TOKEN. Throws
// UserError.
std::optional<ConnectOptions> connectOptions(const RawConnect& raw);
// Crosses out the tokens of links in the command line, which other users of this PC can read; for when it was
// parsed.
void hideTokens(int argc, char** argv);

}  // namespace bonemill
