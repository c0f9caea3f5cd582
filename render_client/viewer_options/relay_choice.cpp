#include "render_client/viewer_options/relay_choice.h"

#include <CLI/CLI.hpp>

#include "common/base/user_error.h"
#include "render_client/viewer_options/network_place.h"
#include "render_client/web/gateway/guest_list.h"
#include "render_client/web/relay/relay_greeting.h"

namespace bonemill {
namespace {

std::string secretOf(const RawRelay& raw) {
    return readRelaySecret(raw.secret_file.empty() ? (gateway::configFolder() / "relay-secret").string()
                                                   : raw.secret_file);
}

}  // namespace

CLI::Option* addRelayOptions(CLI::App& app, RawRelay& raw, CLI::Option* serve,
                             const std::vector<CLI::Option*>& others) {
    CLI::Option* const relay =
        app.add_option("--relay", raw.place,
                       "No viewer: pass guests on to a gateway that dials out to here (--via); on this PC "
                       "alone, unless an address is given, such as 0.0.0.0:8443")
            ->type_name("[ADDRESS:]PORT");
    for (CLI::Option* option : others) relay->excludes(option);
    app.add_option("--via", raw.via, "Guests reach this gateway through this relay, too")
        ->type_name("HOST:PORT")
        ->needs(serve);
    app.add_option("--relay-secret", raw.secret_file,
                   "What relay and gateway both know, at least 32 letters, readable for nobody else (default "
                   "~/.config/bonemill/relay-secret)")
        ->type_name("FILE");
    return relay;
}

std::optional<RelayOptions> relayOptions(const RawRelay& raw) {
    if (!raw.secret_file.empty() && !raw.place && !raw.via)
        throw UserError("--relay-secret needs --relay, or --serve with --via");
    if (!raw.place) return std::nullopt;
    RelayOptions options;
    const NetworkPlace place = placeOf("--relay", *raw.place, options.address);
    options.address = place.host;
    options.port = place.port;
    options.secret = secretOf(raw);
    return options;
}

std::optional<RelayPlace> relayPlace(const RawRelay& raw) {
    if (!raw.via) return std::nullopt;
    const NetworkPlace place = placeOf("--via", *raw.via);
    if (place.port == 0) throw UserError("--via " + *raw.via + ": a relay has a port, such as 8443");
    return RelayPlace{place.host, place.port, secretOf(raw)};
}

}  // namespace bonemill
