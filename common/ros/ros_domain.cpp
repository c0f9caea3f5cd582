#include "common/ros/ros_domain.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <string_view>

#include "common/base/user_error.h"
#include "common/dds/network.h"

namespace bonemill::ros2 {
namespace {

constexpr size_t kLongestNamespace = 100;

// Others may claim any length for a message; ours are far shorter (BoneMarkers::kPartBytes).
constexpr char kBounds[] =
    "<CycloneDDS><Domain Id=\"any\"><Internal><MaxSampleSize>4 "
    "MB</MaxSampleSize></Internal></Domain></CycloneDDS>";

// Nodes that are confined to the loopback find each other by their ports, or by multicast: this is found by
// both.
constexpr char kByPorts[] =
    ",<CycloneDDS><Domain Id=\"any\"><Discovery><ParticipantIndex>auto</ParticipantIndex>"
    "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex><Peers><Peer "
    "Address=\"127.0.0.1\"/></Peers></Discovery>"
    "</Domain></CycloneDDS>";

std::string variable(const char* name) {
    const char* const value = std::getenv(name);
    return value ? value : "";
}

std::string configuration() {
    if (const std::string uri = variable("CYCLONEDDS_URI"); !uri.empty()) return uri + "," + kBounds;
    if (!isLocalhostOnly()) return kBounds;
    return dds::networkConfiguration({.profile = "one-pc"}) + kByPorts + "," + kBounds;
}

bool isPart(std::string_view part) {
    const auto may_stand = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
    return !part.empty() && !std::isdigit(static_cast<unsigned char>(part.front())) &&
           std::ranges::all_of(part, may_stand);
}

}  // namespace

RosOptions rosOptionsOfEnvironment() {
    RosOptions options;
    const std::string text = variable("ROS_DOMAIN_ID");
    const char* const end = text.data() + text.size();
    const auto read = std::from_chars(text.data(), end, options.domain);
    if (!text.empty() && (read.ptr != end || read.ec != std::errc()))
        throw UserError("ROS_DOMAIN_ID is " + text + ": it should be a number, 0 to " +
                        std::to_string(dds::kMaxDomain));
    return options;
}

void addRosDomainOption(CLI::App& app, RosOptions& options) {
    app.add_option("--ros-domain", options.domain, "Domain of the ROS 2 nodes; default: ROS_DOMAIN_ID, or 0")
        ->check(CLI::Range(uint32_t(0), dds::kMaxDomain));
}

std::string requireNamespace(const std::string& name_space) {
    std::string_view rest = name_space;
    if (rest.starts_with('/')) rest.remove_prefix(1);
    const std::string name(rest);
    for (bool is_last = false; !is_last && name.size() <= kLongestNamespace;) {
        const size_t end = rest.find('/');
        is_last = end == std::string_view::npos;
        if (!isPart(rest.substr(0, end))) break;
        if (is_last) return name;
        rest.remove_prefix(end + 1);
    }
    throw UserError("namespace " + name_space + ": give letters, digits and _, as in bonemill or lab/drill");
}

bool isLocalhostOnly() {
    const std::string range = variable("ROS_AUTOMATIC_DISCOVERY_RANGE");
    const bool is_asked = variable("ROS_LOCALHOST_ONLY") == "1" || range == "LOCALHOST" || range == "OFF";
    return is_asked && variable("CYCLONEDDS_URI").empty();
}

dds::Participant joinRos(const RosOptions& options) {
    return dds::Participant::ofForeigners(options.domain, configuration());
}

}  // namespace bonemill::ros2
