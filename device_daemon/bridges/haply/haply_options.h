// The options of the bridge to Haply alone.
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <cstdint>
#include <string>

namespace bonemill::bridge {

struct HaplyOptions {
    std::string host = "127.0.0.1";
    uint16_t port = 10001;
    std::string version = "3.5";
    // In the service's axes; it is where the vendor's documentation shows an arm at rest.
    std::array<double, 3> origin_mm{0, -120, 150};
};

inline void addHaplyOptions(CLI::App& app, HaplyOptions& options) {
    app.add_option("--service-host", options.host, "PC with the Inverse Service")->capture_default_str();
    app.add_option("--service-port", options.port, "Port of its simulation channel")->capture_default_str();
    app.add_option("--service-version", options.version,
                   "Its version; those before 3.5 spell forces otherwise")
        ->capture_default_str();
    app.add_option("--origin-mm", options.origin_mm,
                   "What the service calls the middle of the workspace (x right, y forward, z up)")
        ->capture_default_str();
}

}  // namespace bonemill::bridge
