// The way of a viewer into a session: a DDS participant, or a gateway, with all that it reads and writes. It
// can be made anew, as if the viewer had been started again. For one thread.
#pragma once

#include <memory>
#include <optional>

#include "render_client/link/subscribe/density_feed.h"
#include "render_client/link/subscribe/hand_speaker.h"
#include "render_client/link/subscribe/server_readers.h"
#include "render_client/link/subscribe/wire.h"

namespace bonemill {

struct SessionLink {
    // Says all as this sender and role; wishes of the hand are counted from `first_wish`. Goes through
    // `remote` where there is one, which must outlive the link. Throws UserError when the DDS domain cannot
    // be joined.
    SessionLink(uint32_t domain, RemoteSession* remote, uint32_t session, uint64_t sender,
                topics::Viewer::Role role, uint32_t first_wish)
        : participant(remote ? std::nullopt : std::make_optional<dds::Participant>(domain)),
          wire(remote ? Wire(*remote, session) : Wire(*participant)),
          viewer_reader(wire),
          servers(std::make_unique<ServerReaders>(wire, viewer_reader)),
          viewer_writer(wire),
          hand(wire, session, sender, role, first_wish),
          density_feed(wire, session, sender),
          command_writer(wire) {}

    // What was refused meanwhile, DDS gives to new readers only.
    void readAnew() { servers = std::make_unique<ServerReaders>(wire, viewer_reader); }
    // It is the way to the gateway that is lost, whatever became of the server.
    bool isCut() const { return wire.remote && wire.remote->isCut(); }

    std::optional<dds::Participant> participant;
    const Wire wire;
    Inlet<dds::ViewerSample> viewer_reader;
    std::unique_ptr<ServerReaders> servers;
    Outlet<dds::ViewerSample> viewer_writer;
    HandSpeaker hand;
    DensityFeed density_feed;
    Outlet<dds::CommandSample> command_writer;
};

}  // namespace bonemill
