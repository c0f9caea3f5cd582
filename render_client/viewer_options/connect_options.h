// Options of render_client --connect, which reaches a session through a gateway (docs/lab/gateway.md).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/web_socket/web_line.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace bonemill {

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
