// The command line of device_daemon, which main.cpp reads.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "common/dds/network.h"
#include "common/rt/realtime.h"

namespace bonemill {

inline constexpr char kScriptedHand[] = "simulated";  // the word for --device

struct DaemonOptions {
    std::string scene;
    std::string device = "auto";  // device_choice.h
    uint32_t session = 1;
    uint32_t domain = 0;  // DDS domain of the viewers, for the pointer
    dds::NetworkOptions network;
    std::optional<double> seconds;       // with haptic_server; not given: until the device leaves
    std::optional<double> wait_seconds;  // how long to wait for haptic_server; not given: for ever
    bool hold = false;                   // the scripted hand rests at its last waypoint
    bool has_enabling_switch = true;
    bool describe = false;
    bool list = false;
    std::string pedal;  // a path in /dev/input; empty: none
    std::filesystem::path stop_dir;
    bool is_strict_realtime = false;
    int core = coreFromLast(1);  // haptic_server's tick has the last
    std::string log_level = "info";
};

}  // namespace bonemill
