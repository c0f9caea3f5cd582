// Finds and opens spacenavd's socket.
//
// It makes system calls and is not for the loop.
#pragma once

#include <string>

#include "device_daemon/hands/input/spnav_stream.h"

namespace bonemill {

// Returns what the environment variable SPNAV_SOCKET says, or else spacenavd's own place.
std::string spnavSocketPath();

// Returns a connected socket that never blocks, or -1 with errno.
int connectSpnav(const std::string& path);

// They return false when the socket takes nothing.
bool askForProtocol(int socket);
bool askForDevice(int socket);

// What --list wants to know.
enum class SpnavState {
    kNoSocket,   // spacenavd is not installed, or does not run
    kForbidden,  // the socket may not be opened
    kSilent,     // no daemon listens behind the socket
    kNoDevice,   // it runs, and has no device
    kReady,
};
// Waits for spacenavd's answers, half a second at most. One that speaks protocol 0 counts as ready.
SpnavState probeSpnav(const std::string& path);

}  // namespace bonemill
