// Reaches another PC by TCP. The sockets do not block, and other programs do not inherit them.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "common/tcp/descriptor.h"

namespace bonemill {

struct Dialled {
    Descriptor socket;    // connected, or none
    std::string problem;  // why there is none, in words that follow "HOST:PORT: "
};

// Tries the host's addresses one after the other until one answers; each gets its share of the time. It
// waits, also for the name's address, but not once `wake` (a file, or -1) can be read.
Dialled dial(const std::string& host, uint16_t port, std::chrono::milliseconds patience, int wake = -1);
// Begins to connect to where this connected socket leads: the new one can be written to when it is done
// (hasConnected()), or has an error then. Waits for nothing. Nothing when `socket` has lost its other end.
Descriptor beginDialAsOf(int socket);
bool hasConnected(int socket);

}  // namespace bonemill
