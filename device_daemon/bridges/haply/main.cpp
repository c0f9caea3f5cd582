// bonemill_bridge_haply lets device_daemon use an Inverse3 or Minverse of Haply (docs/howto/bridges.md).
#include "device_daemon/bridges/bridge/bridge_main.h"
#include "device_daemon/bridges/haply/haply_arm.h"

namespace {

void addOptions(CLI::App& app, bonemill::bridge::HaplyOptions& options) {
    app.add_option("--service-host", options.host, "PC with the Inverse Service")->capture_default_str();
    app.add_option("--service-port", options.port, "Port of its simulation channel")->capture_default_str();
    app.add_option("--service-version", options.version,
                   "Its version; those before 3.5 spell forces otherwise")
        ->capture_default_str();
    app.add_option("--origin-mm", options.origin_mm,
                   "What the service calls the middle of the workspace (x right, y forward, z up)")
        ->capture_default_str();
}

}  // namespace

int main(int argc, char** argv) {
    using namespace bonemill::bridge;
    HaplyOptions haply;
    return runBridge(
        argc, argv,
        {.about = "Bridge between device_daemon and an Inverse3 or Minverse of Haply, through their Inverse "
                  "Service",
         .add_options = [&](CLI::App& app) { addOptions(app, haply); },
         .make_arm =
             [&](const BridgeOptions& options) { return std::make_unique<HaplyArm>(options, haply); }});
}
