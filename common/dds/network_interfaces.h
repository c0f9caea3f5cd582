// Lists the network interfaces of this PC. Any thread may call it, but not the tick.
#pragma once

#include <string>
#include <vector>

namespace bonemill::dds {

struct NetworkInterface {
    std::string name;
    std::string address;  // IPv4, dotted
    bool is_up = false;
};

// These are those with an IPv4 address, without the loopback; there is one entry per address.
std::vector<NetworkInterface> networkInterfaces();

// Writes them as "eth0 (192.168.1.5), wlan0 (10.0.0.3, down)".
std::string textOf(const std::vector<NetworkInterface>& interfaces);

}  // namespace bonemill::dds
