// Options of render_client --serve, which makes it a gateway instead of a viewer (docs/lab/gateway.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render_client/web/gateway/gateway_options.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace bonemill {

struct RawServe {
    std::optional<std::string> place;  // [ADDRESS:]PORT
    gateway::GatewayOptions options;
};

// Excludes what only viewers have; returns the option that asks for a gateway. `raw` must outlive the
// parsing.
CLI::Option* addServeOptions(CLI::App& app, RawServe& raw, const std::vector<CLI::Option*>& viewer_options);
// Returns nothing where no gateway is asked for. Throws UserError.
std::optional<gateway::GatewayOptions> serveOptions(const RawServe& raw);

}  // namespace bonemill
