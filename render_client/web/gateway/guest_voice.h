// Says in the session, by DDS, what guests ask for, as the guest list knows them. For one thread.
#pragma once

#include <optional>
#include <string>

#include "common/dds/endpoint.h"
#include "proto/topics.pb.h"

namespace bonemill::gateway {

// So the session knows a guest.
struct Speaker {
    uint64_t sender = 0;
    std::string name;
    topics::Viewer::Role role = topics::Viewer::VIEWER;
    std::string link;  // "browser", "viewer"
};

class GuestVoice {
  public:
    // It has joined no domain yet, and nobody hears it.
    explicit GuestVoice(uint32_t session) : session_(session) {}

    // The participant must outlive the object, or leave() comes before. Throws UserError.
    void join(const dds::Participant& participant) { mouth_.emplace(participant); }
    void leave() { mouth_.reset(); }

    void announce(const Speaker& speaker, topics::Viewer viewer);
    // The role must be one that may order it (role_rules.h).
    void command(const Speaker& speaker, topics::Command command);
    void hand(const Speaker& speaker, topics::HandPointer hand);
    void wish(const Speaker& speaker, topics::DensityWish wish);

  private:
    // What it speaks to the domain by.
    struct Mouth {
        explicit Mouth(const dds::Participant& participant)
            : viewers(participant), hands(participant), commands(participant), wishes(participant) {}

        dds::Writer<dds::ViewerSample> viewers;
        dds::Writer<dds::HandPointerSample> hands;
        dds::Writer<dds::CommandSample> commands;
        dds::Writer<dds::DensityWishSample> wishes;
    };

    const uint32_t session_;
    std::optional<Mouth> mouth_;
};

}  // namespace bonemill::gateway
