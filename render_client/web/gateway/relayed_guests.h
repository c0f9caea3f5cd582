// Guests who come through a relay, on their way from the thread that dials to that of the gateway.
#pragma once

#include <functional>
#include <mutex>
#include <vector>

#include "render_client/web/gateway/guest_list.h"
#include "render_client/web/relay/relay_dialer.h"

namespace bonemill::gateway {

class RelayedGuests {
  public:
    struct Arrival {
        Descriptor line;  // the guest's TLS comes from there
        GuestOrigin origin;
    };
    // Registers with the relay from now on, again and again if need be. `wake` is called by another thread
    // when somebody has come; it must outlive the object.
    RelayedGuests(const RelayPlace& relay, std::function<void()> wake);

    // Returns who has come since. Any thread.
    std::vector<Arrival> take();

  private:
    std::function<void()> wake_;
    std::mutex mutex_;
    std::vector<Arrival> arrivals_;
    RelayDialer dialer_;  // last: its thread uses the others
};

}  // namespace bonemill::gateway
