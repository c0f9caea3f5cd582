// Options of render_client that have to do with a relay: to be one (--relay), or to be reached through one
// (--serve with --via). docs/lab/gateway.md says how they meet.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render_client/web/relay/relay_options.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace bonemill {

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

}  // namespace bonemill
