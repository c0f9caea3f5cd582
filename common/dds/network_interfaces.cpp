#include "common/dds/network_interfaces.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>

namespace bonemill::dds {
namespace {

std::string addressOf(const ifaddrs& entry) {
    char text[INET_ADDRSTRLEN] = "";
    inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(entry.ifa_addr)->sin_addr, text, sizeof text);
    return text;
}

}  // namespace

std::vector<NetworkInterface> networkInterfaces() {
    std::vector<NetworkInterface> interfaces;
    ifaddrs* first = nullptr;
    if (getifaddrs(&first) != 0) return interfaces;
    for (const ifaddrs* entry = first; entry != nullptr; entry = entry->ifa_next) {
        const bool is_ipv4 = entry->ifa_addr != nullptr && entry->ifa_addr->sa_family == AF_INET;
        if (!is_ipv4 || (entry->ifa_flags & IFF_LOOPBACK)) continue;
        interfaces.push_back({entry->ifa_name, addressOf(*entry), (entry->ifa_flags & IFF_UP) != 0});
    }
    freeifaddrs(first);
    return interfaces;
}

std::string textOf(const std::vector<NetworkInterface>& interfaces) {
    std::string text;
    for (const NetworkInterface& interface : interfaces) {
        if (!text.empty()) text += ", ";
        text += interface.name + " (" + interface.address + (interface.is_up ? ")" : ", down)");
    }
    return text.empty() ? "none with an IPv4 address" : text;
}

}  // namespace bonemill::dds
