#include "render_client/viewer_options/serve_options.h"

#include <CLI/CLI.hpp>

#include "common/cli/command_line.h"
#include "render_client/viewer_options/network_place.h"

namespace bonemill {
namespace {

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

}  // namespace bonemill
