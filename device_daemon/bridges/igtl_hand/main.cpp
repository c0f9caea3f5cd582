// bonemill_bridge_igtl lets device_daemon use a hand that another program tells by OpenIGTLink
// (docs/howto/bridges.md).
#include "common/cli/command_line.h"
#include "device_daemon/bridges/bridge/bridge_main.h"
#include "device_daemon/bridges/igtl_hand/igtl_hand.h"

namespace {

void addOptions(CLI::App& app, bonemill::bridge::IgtlHandOptions& options) {
    using bonemill::within;
    app.add_option("--igtl-port", options.port, "TCP port that the peer comes to; 0 takes any free one")
        ->capture_default_str();
    app.add_option("--igtl-address", options.address, "Address of this PC that it comes to")
        ->capture_default_str();
    app.add_option("--peer", options.peer, "Only this address may hold the hand (default: this PC)")
        ->type_name("ADDRESS");
    app.add_option("--transform", options.device,
                   "Device name of the TRANSFORM that is the hand (default: any)")
        ->type_name("NAME");
    app.add_option("--axes", options.axes,
                   "Which of the peer's axes are to the operator's left, towards the operator, and up")
        ->capture_default_str();
    app.add_option("--origin-mm", options.origin_mm, "What the peer calls the middle of the workspace")
        ->capture_default_str();
    app.add_flag("--place-only", options.is_place_only,
                 "Take where the hand is and not how it is turned, of a peer that does not know it");
    app.add_option("--max-torque-nm", options.max_torque, "The peer gives no more torque than this; 0: none")
        ->check(within(0, 100))
        ->capture_default_str();
    app.add_option("--workspace-mm", options.workspace_mm, "Radius of the peer's workspace")
        ->check(within(1, 5000))
        ->capture_default_str();
}

}  // namespace

int main(int argc, char** argv) {
    using namespace bonemill::bridge;
    IgtlHandOptions hand;
    return runBridge(
        argc, argv,
        {.about =
             "Bridge between device_daemon and a hand that another program tells by OpenIGTLink's TRANSFORM",
         .add_options = [&](CLI::App& app) { addOptions(app, hand); },
         .make_arm =
             [&](const BridgeOptions& options) { return std::make_unique<IgtlHand>(options, hand); }});
}
