// bonemill_bridge_ros2 lets a robot or a program of ROS 2 be device_daemon's hand (docs/howto/ros2.md).
#include <iostream>

#include "common/base/user_error.h"
#include "common/log/log.h"
#include "common/ros/ros_domain.h"
#include "device_daemon/bridges/bridge/bridge_main.h"
#include "device_daemon/bridges/ros2_arm/ros2_arm.h"

int main(int argc, char** argv) {
    using namespace bonemill;
    setUpLog("bonemill_bridge_ros2", "warn");
    ros2::RosOptions ros;
    try {
        ros = ros2::rosOptionsOfEnvironment();
    } catch (const UserError& error) {
        std::cerr << "error: " << error.what() << std::endl;
        return kUserErrorExitCode;
    }
    return bridge::runBridge(argc, argv,
                             {.about = "Bridge between device_daemon and a hand of ROS 2: NAMESPACE/servo_cp "
                                       "comes, NAMESPACE/measured_cf "
                                       "goes; --device NAMESPACE",
                              .add_options = [&](CLI::App& app) { ros2::addRosDomainOption(app, ros); },
                              .make_arm =
                                  [&](const bridge::BridgeOptions& options) {
                                      return std::make_unique<bridge::Ros2Arm>(options, ros);
                                  }});
}
