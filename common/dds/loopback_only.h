// Keeps Cyclone's sockets to this PC: it binds those that receive to all addresses, whatever interface it is
// told to use, and would hear every host on the LAN.
#pragma once

#include <set>

namespace bonemill::dds {

class LoopbackOnly {
  public:
    // Notes which descriptors are open.
    LoopbackOnly();
    // Ties all UDP sockets that were opened since to the loopback: nothing from elsewhere reaches them any
    // more. Returns how many there are. Throws UserError where the kernel does not let it.
    int tie() const;

  private:
    std::set<int> before_;
};

}  // namespace bonemill::dds
