// bonemill_bridge_force_dimension lets device_daemon use an arm of Force Dimension or a Falcon
// (docs/howto/bridges.md).
#include "device_daemon/bridges/bridge/bridge_main.h"
#include "device_daemon/bridges/force_dimension/force_dimension_arm.h"

int main(int argc, char** argv) {
    using namespace bonemill::bridge;
    return runBridge(
        argc, argv,
        {.about =
             "Bridge between device_daemon and an arm of Force Dimension or a Falcon, through libdrd.so.3",
         .make_arm = [](const BridgeOptions& options) {
             return std::make_unique<ForceDimensionArm>(options);
         }});
}
