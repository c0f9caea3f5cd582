#include "render_client/viewer_options/connect_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <span>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

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
