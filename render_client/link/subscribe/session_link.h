// The way of a viewer into a session: a DDS participant, or a gateway, with all that it writes, and the
// densities. It can be made anew, as if the viewer had been started again. For one thread.
#pragma once

#include <optional>

#include "render_client/link/subscribe/density_feed.h"
#include "render_client/link/subscribe/hand_speaker.h"
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
          viewer_writer(wire),
          hand(wire, session, sender, role, first_wish),
          density_feed(wire, session, sender),
          command_writer(wire) {}

    std::optional<dds::Participant> participant;
    const Wire wire;
    Outlet<dds::ViewerSample> viewer_writer;
    HandSpeaker hand;
    DensityFeed density_feed;
    Outlet<dds::CommandSample> command_writer;
};

}  // namespace bonemill
