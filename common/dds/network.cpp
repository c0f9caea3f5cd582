#include "common/dds/network.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "common/base/user_error.h"
#include "common/dds/participant.h"
#include "common/files/require_file.h"
#include "common/security/security_folder.h"
#include "profiles.h"

namespace bonemill::dds {
namespace {

std::string addressOf(const ifaddrs& entry) {
    char text[INET_ADDRSTRLEN] = "";
    inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(entry.ifa_addr)->sin_addr, text, sizeof text);
    return text;
}

// These are places in a profile, in Cyclone's notation: a profile also works with CYCLONEDDS_URI
// and these variables.
constexpr char kAddressPlace[] = "${BONEMILL_ADDRESS}";
constexpr char kPriorityPlace[] = "${BONEMILL_LAN_PRIORITY:-default}";
constexpr char kAboveLoopback[] = "3";

bool isSetInEnvironment() {
    const char* uri = std::getenv("CYCLONEDDS_URI");
    return uri != nullptr && *uri != '\0';
}

std::string readProfile(const std::string& path) {
    requireFile(path);
    std::ifstream file(path);
    std::ostringstream content;
    if (!(content << file.rdbuf())) throw UserError("--profile " + path + ": this file cannot be read");
    return content.str();
}

std::string profileText(const std::string& profile) {
    if (profile.empty() || profile == "one-pc") return kOnePcProfile;
    if (profile == "lab") return kLabProfile;
    if (profile == "classroom") return kClassroomProfile;
    if (profile.find_first_of("./") == std::string::npos)
        throw UserError("--profile " + profile + ": choose one-pc, lab, classroom or a FILE.xml");
    return readProfile(profile);
}

std::string addressOfInterface(const std::string& wanted) {
    const std::vector<NetworkInterface> all = networkInterfaces();
    const auto found = std::find_if(all.begin(), all.end(), [&](const NetworkInterface& interface) {
        return interface.name == wanted || interface.address == wanted;
    });
    if (found == all.end())
        throw UserError("--interface " + wanted + ": this PC has no such interface; it has: " + textOf(all));
    if (!found->is_up) throw UserError("--interface " + wanted + ": this interface is down; check the cable");
    return found->address;
}

std::string replaced(std::string text, const std::string& place, const std::string& value) {
    for (size_t at = text.find(place); at != std::string::npos; at = text.find(place, at + value.size()))
        text.replace(at, place.size(), value);
    return text;
}

// Puts this PC's address where the profile wants it.
std::string withAddress(std::string text, const NetworkOptions& options) {
    if (text.find(kAddressPlace) == std::string::npos) {
        if (options.interface.empty()) return text;
        throw UserError("--interface " + options.interface +
                        ": this profile asks for none; did you mean --profile lab?");
    }
    if (options.interface.empty())
        throw UserError("--profile " + options.profile +
                        " needs --interface, the one that leads to the other PCs; this PC has: " +
                        textOf(networkInterfaces()));
    return replaced(std::move(text), kAddressPlace, addressOfInterface(options.interface));
}

std::string addressOfPeer(const std::string& peer) {
    addrinfo hints{};
    hints.ai_family = AF_INET;
    hints.ai_socktype = SOCK_DGRAM;
    addrinfo* found = nullptr;
    if (getaddrinfo(peer.c_str(), nullptr, &hints, &found) != 0)
        throw UserError("--peer " + peer +
                        ": neither an IPv4 address nor the name of a PC that is known here");
    char text[INET_ADDRSTRLEN] = "";
    inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(found->ai_addr)->sin_addr, text, sizeof text);
    freeaddrinfo(found);
    return text;
}

// A later fragment overrides and adds to the earlier ones.
std::string peerFragment(const std::vector<std::string>& peers) {
    std::string text =
        ",<CycloneDDS><Domain Id=\"any\"><General><AllowMulticast>false</AllowMulticast></General>"
        "<Discovery><Peers>";
    for (const std::string& peer : peers) text += "<Peer Address=\"" + addressOfPeer(peer) + "\"/>";
    return text + "</Peers></Discovery></Domain></CycloneDDS>";
}

// Who starts a viewer as the server would be a server for all others.
void requirePart(const SecurityFolder& security, NetworkPart part) {
    const Identity& self = security.self();
    const NetworkPart made_for = self.role == "server"   ? NetworkPart::kServer
                                 : self.role == "device" ? NetworkPart::kDevice
                                                         : NetworkPart::kViewer;
    if (part == made_for) return;
    constexpr const char* kWanted[] = {"the folder server", "the folder device", "a person's folder"};
    throw UserError("--secure " + security.folder().string() + ": this is " + self.name + "'s folder (" +
                    self.role + "); this program needs " + kWanted[size_t(part)]);
}

// People of another session would be strangers here, and this program a stranger to them.
void requireSession(const SecurityFolder& security, uint32_t session) {
    const std::optional<uint32_t> made_for = security.self().session;
    if (made_for == session) return;
    const std::string folder = "--secure " + security.folder().string();
    if (!made_for) throw UserError(folder + ": its certificate names no session; " + kMakeNewSession);
    throw UserError(folder + ": this folder was made for session " + std::to_string(*made_for) +
                    ", and this is session " + std::to_string(session) + "; give --session " +
                    std::to_string(*made_for) + ", or the folder of session " + std::to_string(session));
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

bool isLanProfile(const std::string& profile) {
    return profile == "lab" || profile == "classroom";
}

std::string networkConfiguration(const NetworkOptions& options) {
    if (options.profile.empty() && isSetInEnvironment()) {
        if (options.interface.empty() && options.peers.empty()) return "";
        throw UserError("--interface and --peer do not go with CYCLONEDDS_URI: write both into its file");
    }
    if (isSetInEnvironment())
        throw UserError("--profile " + options.profile +
                        " and CYCLONEDDS_URI are both given: unset CYCLONEDDS_URI or leave --profile out");
    const std::string text = withAddress(profileText(options.profile), options);
    if (options.peers.empty()) return text;
    if (options.profile.empty() || options.profile == "one-pc")
        throw UserError("--peer " + options.peers.front() + ": profile one-pc has none; use --profile lab");
    return replaced(text, kPriorityPlace, kAboveLoopback) + peerFragment(options.peers);
}

bool isOnePc(const std::string& configuration) {
    return configuration.starts_with(kOnePcProfile);
}

bool isOpenToOthers(const NetworkOptions& options) {
    const bool is_one_pc = options.profile == "one-pc" || (options.profile.empty() && !isSetInEnvironment());
    return options.secure.empty() && !is_one_pc;
}

std::optional<Identity> identityOf(const NetworkOptions& options) {
    if (options.secure.empty()) return std::nullopt;
    return SecurityFolder(options.secure).self();
}

void setNetwork(const NetworkOptions& options, NetworkPart part, std::optional<uint32_t> session) {
    Participant::setConfiguration(networkConfiguration(options));
    std::optional<SecurityFolder> security;
    if (!options.secure.empty()) security.emplace(options.secure);
    if (security) {
        requirePart(*security, part);
        if (session) requireSession(*security, *session);
    }
    Participant::setSecurity(std::move(security));
}

}  // namespace bonemill::dds
