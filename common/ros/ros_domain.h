// The way into a domain of ROS 2, without any part of ROS: its options, and the participant. It is for the
// start, not for the tick.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "common/dds/participant.h"

namespace bonemill::ros2 {

struct RosOptions {
    uint32_t domain = 0;
};

// The domain is that of ROS_DOMAIN_ID. Throws UserError where it says no number.
RosOptions rosOptionsOfEnvironment();

void addRosDomainOption(CLI::App& app, RosOptions& options);

// Throws UserError for what ROS 2 takes for no name: parts of letters, digits and _, joined by /. A leading /
// is dropped.
std::string requireNamespace(const std::string& name_space);

// Only nodes of this PC are heard: ROS_LOCALHOST_ONLY is 1, or ROS_AUTOMATIC_DISCOVERY_RANGE is LOCALHOST, or
// OFF, which is less yet. With CYCLONEDDS_URI nobody knows who hears.
bool isLocalhostOnly();

// Joins as a node would: by CYCLONEDDS_URI where it is set, else on this PC's network or, with
// isLocalhostOnly(), on its loopback. Throws UserError.
dds::Participant joinRos(const RosOptions& options);

}  // namespace bonemill::ros2
