#include "render_client/app/serve_options.h"

#include <CLI/CLI.hpp>
#include <charconv>

#include "common/cli/number_range.h"
#include "common/user_error.h"

namespace bonemill {
namespace {

// "8443", "0.0.0.0:8443", "[::1]:8443"
void parsePlace(const std::string& place, gateway::GatewayOptions& options) {
    const size_t colon = place.rfind(':');
    const std::string port = colon == std::string::npos ? place : place.substr(colon + 1);
    const char* const end = port.data() + port.size();
    const auto [rest, error] = std::from_chars(port.data(), end, options.port);
    std::string address = colon == std::string::npos ? options.address : place.substr(0, colon);
    if (address.starts_with('[') && address.ends_with(']')) address = address.substr(1, address.size() - 2);
    if (error != std::errc() || rest != end || port.empty() || address.empty())
        throw UserError("--serve " + place + ": expected PORT or ADDRESS:PORT, such as 8443 or 0.0.0.0:8443");
    options.address = address;
}

std::filesystem::path builtPage() {
    std::error_code error;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
    return program.parent_path().parent_path() / "page";
}

}  // namespace

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
    return serve;
}

std::optional<gateway::GatewayOptions> serveOptions(const RawServe& raw) {
    if (!raw.place) return std::nullopt;
    gateway::GatewayOptions options = raw.options;
    parsePlace(*raw.place, options);
    if (options.page.empty()) options.page = builtPage();
    return options;
}

}  // namespace bonemill
