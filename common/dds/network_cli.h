// Every program chooses its network with these options.
#pragma once

#include <CLI/CLI.hpp>

#include "common/dds/network.h"

namespace bonemill::dds {

inline void addNetworkOptions(CLI::App& app, NetworkOptions& network) {
    app.add_option("--profile", network.profile,
                   "network: one-pc (default), lab, classroom, or a Cyclone DDS file (docs/howto/network.md)")
        ->type_name("NAME|FILE.xml");
    app.add_option("--interface", network.interface,
                   "this PC's interface to the others, name or IPv4 address; for lab and classroom")
        ->type_name("NAME|ADDRESS");
    app.add_option("--peer", network.peers, "a PC to look for where multicast does not work; may be repeated")
        ->type_name("ADDRESS")
        ->expected(1)
        ->take_all();
    app.add_option("--secure", network.secure,
                   "folder of deploy/security/make-session: only its people join (docs/howto/security.md)")
        ->type_name("DIR");
}

}  // namespace bonemill::dds
