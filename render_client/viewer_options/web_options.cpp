#include "render_client/viewer_options/web_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <span>

#include "common/base/user_error.h"
#include "common/cli/command_line.h"
#include "common/files/config_folder.h"
#include "common/secrets/secrets.h"
#include "render_client/web/relay/relay_greeting.h"

namespace bonemill {
namespace {

std::string secretOf(const RawRelay& raw) {
    return readSecret(raw.secret_file.empty() ? (configFolder() / "relay-secret").string() : raw.secret_file,
                      "a relay");
}

std::filesystem::path builtPage() {
    std::error_code error;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
    return program.parent_path().parent_path() / "page";
}

// Splits "wss://host:port/#token"; https stands for the same.
ConnectOptions parseLink(const std::string& link) {
    ConnectOptions options;
    const size_t scheme = link.starts_with("wss://") ? 6 : link.starts_with("https://") ? 8 : 0;
    const size_t hash = link.find('#');
    std::string place = link.substr(scheme, hash == std::string::npos ? hash : hash - scheme);
    if (hash != std::string::npos) options.token = link.substr(hash + 1);
    if (place.ends_with('/')) place.pop_back();
    const size_t colon = place.rfind(':');
    const bool has_port = colon != std::string::npos && place.find(']', colon) == std::string::npos;
    bool is_good = scheme > 0 && place.find_first_of("/?@") == std::string::npos;
    if (has_port) {
        const char* const end = place.data() + place.size();
        const auto [rest, error] = std::from_chars(place.data() + colon + 1, end, options.target.port);
        is_good = is_good && error == std::errc() && rest == end;
        place.resize(colon);
    }
    if (place.starts_with('[') && place.ends_with(']')) place = place.substr(1, place.size() - 2);
    options.target.host = place;
    if (!is_good || place.empty())
        throw UserError("--connect: expected wss://HOST:PORT, or the link of an invitation");
    return options;
}

std::string firstLineOf(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::string line;
    if (!stream || !std::getline(stream, line)) throw UserError(file.string() + ": has no token");
    // The whole link will do.
    return line.substr(line.find('#') == std::string::npos ? 0 : line.find('#') + 1);
}

}  // namespace

NetworkPlace placeOf(const std::string& option, const std::string& text, const std::string& assumed_host) {
    const size_t colon = text.rfind(':');
    const std::string port = colon == std::string::npos ? text : text.substr(colon + 1);
    NetworkPlace place{colon == std::string::npos ? assumed_host : text.substr(0, colon)};
    const char* const end = port.data() + port.size();
    const auto [rest, error] = std::from_chars(port.data(), end, place.port);
    if (place.host.starts_with('[') && place.host.ends_with(']'))
        place.host = place.host.substr(1, place.host.size() - 2);
    if (error == std::errc() && rest == end && !place.host.empty()) return place;
    throw UserError(option + " " + text + ": expected " +
                    (assumed_host.empty() ? "HOST:PORT, such as relay.example.org:8443"
                                          : "PORT or ADDRESS:PORT, such as 8443 or 0.0.0.0:8443"));
}

std::string textOf(const NetworkPlace& place) {
    const bool is_v6 = place.host.find(':') != std::string::npos;
    return (is_v6 ? "[" + place.host + "]" : place.host) + ":" + std::to_string(place.port);
}

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

CLI::Option* addServeOptions(CLI::App& app, RawServe& raw, const std::vector<CLI::Option*>& viewer_options) {
    gateway::GatewayOptions& options = raw.options;
    CLI::Option* const serve =
        app.add_option(
               "--serve", raw.place,
               "No viewer: be a gateway for pages in browsers and for viewers with --connect; on this PC "
               "alone, unless an address is given, such as 0.0.0.0:8443")
            ->type_name("[ADDRESS:]PORT");
    for (CLI::Option* option : viewer_options) serve->excludes(option);
    CLI::Option* const certificate = app.add_option("--certificate", options.certificate,
                                                    "Certificate, PEM (default: one of its own making)")
                                         ->type_name("FILE")
                                         ->needs(serve);
    CLI::Option* const key =
        app.add_option("--key", options.key, "Its private key, PEM")->type_name("FILE")->needs(certificate);
    certificate->needs(key);
    app.add_option("--known-as", options.names,
                   "Another name by which guests reach it, besides those of --certificate; may be repeated")
        ->type_name("HOST")
        ->needs(certificate);
    app.add_option("--guests", options.guests,
                   "Who may come in, as deploy/security/invite writes it (default ~/.config/bonemill/"
                   "guests.textproto)")
        ->type_name("FILE")
        ->needs(serve);
    app.add_option("--page", options.page, "Folder of the page (default: the one of this build)")
        ->type_name("DIR")
        ->needs(serve);
    app.add_option("--guest-mbit-per-s", options.guest_mbit_per_s, "What each guest is sent, at most")
        ->check(within(0.1, 10000))
        ->capture_default_str()
        ->needs(serve);
    app.add_option("--guests-at-once", options.most_guests, "So many guests at most")
        ->check(CLI::Range(1u, gateway::kMaxGuestsOfGateway))
        ->capture_default_str()
        ->needs(serve);
    return serve;
}

std::optional<gateway::GatewayOptions> serveOptions(const RawServe& raw) {
    if (!raw.place) return std::nullopt;
    gateway::GatewayOptions options = raw.options;
    const NetworkPlace place = placeOf("--serve", *raw.place, options.address);
    options.address = place.host;
    options.port = place.port;
    if (options.page.empty()) options.page = builtPage();
    return options;
}

void addConnectOptions(CLI::App& app, RawConnect& raw, const std::vector<CLI::Option*>& others) {
    CLI::Option* const connect =
        app.add_option(
               "--connect", raw.link,
               "Reach the session through a gateway; the invitation's token comes from --token-file or "
               "the variable BONEMILL_TOKEN, as other users of this PC can read a command line")
            ->type_name("wss://HOST:PORT");
    for (CLI::Option* option : others) connect->excludes(option);
    app.add_option(
           "--fingerprint", raw.fingerprint,
           "The gateway's certificate has this SHA-256, as it printed (default: an authority that this "
           "PC trusts knows it)")
        ->needs(connect);
    app.add_option("--token-file", raw.token_file, "Its first line is the token, or the invitation's link")
        ->type_name("FILE")
        ->needs(connect);
}

std::optional<ConnectOptions> connectOptions(const RawConnect& raw) {
    if (!raw.link) return std::nullopt;
    ConnectOptions options = parseLink(*raw.link);
    options.target.fingerprint = raw.fingerprint;
    const char* const variable = std::getenv("BONEMILL_TOKEN");
    if (!options.token.empty()) {
        std::cerr
            << "warning: a token on the command line can be read by other users of this PC at the start, and "
               "later in the shell's history; better: --token-file, or the variable BONEMILL_TOKEN\n";
    } else if (!raw.token_file.empty()) {
        options.token = firstLineOf(raw.token_file);
    } else if (variable && *variable) {
        options.token = variable;
    } else {
        throw UserError("--connect: needs the token of an invitation, by --token-file or BONEMILL_TOKEN");
    }
    return options;
}

void hideTokens(int argc, char** argv) {
    for (char* const argument : std::span(argv, size_t(argc))) {
        char* const token = std::strstr(argument, "://") ? std::strchr(argument, '#') : nullptr;
        if (token) std::fill(token + 1, token + std::strlen(token), 'x');
    }
}

}  // namespace bonemill
