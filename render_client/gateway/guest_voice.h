// Says in the session, by DDS, what guests ask for, as the guest list knows them. For one thread.
#pragma once

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

// The tool, with a mouse.
bool mayHold(topics::Viewer::Role role);

class GuestVoice {
  public:
    // The participant must outlive the object. Throws UserError.
    GuestVoice(const dds::Participant& participant, uint32_t session)
        : session_(session),
          viewers_(participant),
          hands_(participant),
          commands_(participant),
          wishes_(participant) {}

    void announce(const Speaker& speaker, topics::Viewer viewer);
    // It must not come from a VIEWER.
    void command(const Speaker& speaker, topics::Command command);
    void hand(const Speaker& speaker, topics::HandPointer hand);
    void wish(const Speaker& speaker, topics::DensityWish wish);

  private:
    const uint32_t session_;
    dds::Writer<dds::ViewerSample> viewers_;
    dds::Writer<dds::HandPointerSample> hands_;
    dds::Writer<dds::CommandSample> commands_;
    dds::Writer<dds::DensityWishSample> wishes_;
};

}  // namespace bonemill::gateway
