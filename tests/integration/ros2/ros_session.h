// A session on a slab, and a domain of ROS 2 beside it, both of this PC alone and of this test alone.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/dds/participant.h"
#include "tests/support/dds_session.h"
#include "tests/support/process.h"

namespace bonemill::test {

// Never a test's session domain at the same time.
uint32_t rosTestDomain();

class RosSession {
  public:
    // The surface of the slab is at z = 0, its scripted hand presses on it, for hours.
    RosSession();

    // Each program with its words, for a start elsewhere.
    std::vector<std::string> serverWords() const;
    std::vector<std::string> daemonWords(const std::string& device) const;
    static std::vector<std::string> rosWords();
    std::unique_ptr<Process> startServer() const;
    std::unique_ptr<Process> startDaemon(const std::string& device,
                                         const std::vector<std::string>& more = {}) const;
    std::unique_ptr<Process> startRos() const;
    // Joins the domain of ROS as a node of Cyclone DDS.
    dds::Participant joinAsNode() const;
    const TemporaryFolder& folder() const { return folder_; }

  private:
    TemporaryFolder folder_;
};

}  // namespace bonemill::test
