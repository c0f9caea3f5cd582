// A relay and a gateway that is reached through it, as the programs that users start: for tests.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <memory>
#include <string>
#include <vector>

#include "common/web_socket/web_line.h"
#include "tests/support/dds_session.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace bonemill::gateway {

// Waits for this line of what the program prints, and returns what follows `key` up to the line's end.
inline std::string printedAfter(const test::Process& program, const std::string& key) {
    std::string found;
    EXPECT_TRUE(test::waitFor([&] {
        const std::string out = program.outSoFar();
        const size_t at = out.find(key), end = at == std::string::npos ? at : out.find('\n', at);
        if (end != std::string::npos) found = out.substr(at + key.size(), end - at - key.size());
        return !found.empty();
    })) << key
        << "\n"
        << program.outSoFar() << program.errSoFar();
    return found;
}

inline uint16_t portAtTheEndOf(const std::string& place) {
    return uint16_t(std::stoul(place.substr(place.rfind(':') + 1)));
}

class RelayedGateway {
  public:
    explicit RelayedGateway(const std::string& guests, uint32_t most_guests = 64)
        : most_guests_(most_guests) {
        setenv("XDG_CONFIG_HOME", (folder_ / "config").c_str(), 1);
        makeSecret("secret", 'a');
        makeSecret("another", 'b');
        test::writeFile(folder_ / "guests", guests);
        startRelay();
    }

    void startRelay() {
        relay_ = std::make_unique<test::Process>(
            std::vector<std::string>{"render_client", "--relay", "127.0.0.1:" + std::to_string(relay_port_),
                                     "--relay-secret", folder_ / "secret", "--log-level", "debug"});
        relay_port_ = portAtTheEndOf(printedAfter(*relay_, "relay for a gateway with --via: "));
    }
    void startGateway(const std::string& secret = "secret") {
        gateway_ = std::make_unique<test::Process>(std::vector<std::string>{
            "render_client", "--serve", "0", "--via", "127.0.0.1:" + std::to_string(relay_port_),
            "--relay-secret", folder_ / secret, "--session", std::to_string(testSession()), "--domain",
            std::to_string(testDomain()), "--guests", folder_ / "guests", "--guests-at-once",
            std::to_string(most_guests_), "--log-level", "debug"});
        own_port_ = portAtTheEndOf(printedAfter(*gateway_, ": https://"));
        fingerprint_ = printedAfter(*gateway_, "fingerprint (SHA-256): ");
    }
    bool waitUntilReached() const {
        return test::waitFor([&] { return hasSaid(*gateway_, "guests reach this gateway at the relay"); });
    }
    static bool hasSaid(const test::Process& program, const std::string& words) {
        return program.errSoFar().find(words) != std::string::npos;
    }

    WebTarget at(uint16_t port) const { return {"127.0.0.1", port, fingerprint_}; }
    WebTarget throughRelay() const { return at(relay_port_); }
    WebTarget direct() const { return at(own_port_); }
    uint16_t relayPort() const { return relay_port_; }
    test::Process& relay() { return *relay_; }
    test::Process& gatewayProgram() { return *gateway_; }

  private:
    void makeSecret(const std::string& name, char letter) const {
        test::writeFile(folder_ / name, std::string(32, letter) + "\n");
        chmod((folder_ / name).c_str(), S_IRUSR | S_IWUSR);
    }

    test::TemporaryFolder folder_;
    const uint32_t most_guests_;
    uint16_t relay_port_ = 0, own_port_ = 0;
    std::string fingerprint_;
    std::unique_ptr<test::Process> relay_, gateway_;
};

}  // namespace bonemill::gateway
