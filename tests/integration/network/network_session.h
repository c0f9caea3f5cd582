// Runs a session on a virtual network: haptic_server and device_daemon on one PC, viewers on others. The
// simulated hand mills a slab.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/virtual_network.h"

namespace bonemill::test {

using Words = std::vector<std::string>;
Words joined(Words words, const Words& more);

class NetworkSession : public testing::Test {
  protected:
    // Skips the test where no network can be made.
    void SetUp() override;

    // It runs on the haptics PC, the first host; `network` has the options of its network, here and below.
    void startServer(const Words& network);
    // Mills for that long; returns at once. waitForDevice() returns when it has withdrawn.
    void startMilling(int seconds);
    void waitForDevice();
    // Starts a probe_viewer; the other one returns its newest line.
    std::unique_ptr<Process> probe(const Host& host, const Words& network);
    static nlohmann::json newest(const Process& probe);
    // Takes one picture of the whole model, and returns render_client's line.
    nlohmann::json picture(const Host& host, const Words& network);
    // Stops the server, and returns its report.
    nlohmann::json stopServer();

    static bool isWhole(const Process& probe);
    // All of them show the same whole model.
    static bool agree(const std::vector<const Process*>& probes);

    std::unique_ptr<VirtualNetwork> network_;
    std::unique_ptr<Host> haptics_pc_;

  private:
    void writeScene() const;
    TemporaryFolder folder_;
    std::string session_ = std::to_string(getpid());
    std::unique_ptr<Process> server_, daemon_;
};

}  // namespace bonemill::test
