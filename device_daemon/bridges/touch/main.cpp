// bonemill_bridge_touch lets device_daemon use a Touch or Phantom of 3D Systems (docs/howto/bridges.md).
#include "device_daemon/bridges/bridge/bridge_main.h"
#include "device_daemon/bridges/touch/touch_arm.h"

int main(int argc, char** argv) {
    using namespace bonemill::bridge;
    return runBridge(
        argc, argv,
        {.about = "Bridge between device_daemon and a Touch or Phantom of 3D Systems, through libHD.so",
         .make_arm = [](const BridgeOptions& options) { return std::make_unique<TouchArm>(options); }});
}
