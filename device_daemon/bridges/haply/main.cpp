// bonemill_bridge_haply lets device_daemon use an Inverse3 or Minverse of Haply (docs/lab/bridges.md).
#include "device_daemon/bridges/bridge/bridge_main.h"
#include "device_daemon/bridges/haply/haply_arm.h"

int main(int argc, char** argv) {
    using namespace bonemill::bridge;
    HaplyOptions haply;
    return runBridge(
        argc, argv,
        {.about = "Bridge between device_daemon and an Inverse3 or Minverse of Haply, through their Inverse "
                  "Service",
         .add_options = [&](CLI::App& app) { addHaplyOptions(app, haply); },
         .make_arm =
             [&](const BridgeOptions& options) { return std::make_unique<HaplyArm>(options, haply); }});
}
