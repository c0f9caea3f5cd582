// A session that a viewer reaches without DDS: what a gateway passes on (proto/gateway.proto).
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "proto/gateway.pb.h"

namespace bonemill {

namespace gateway {
// What a guest's Hello says; render_client/web/page/src/link/session_socket.ts says the same.
inline constexpr uint32_t kProtocolVersion = 2;
}  // namespace gateway

// next() and wait() are for the thread that shows the session; the others for any.
class RemoteSession {
  public:
    virtual ~RemoteSession() = default;

    // Takes the next sample of this topic that has come; false: there is none.
    virtual bool next(gateway::Sample::Topic topic, gateway::Sample& sample) = 0;
    // Returns true when something can be taken, false when `timeout` passed before.
    virtual bool wait(std::chrono::nanoseconds timeout) = 0;
    // The gateway hears the session's server.
    virtual bool hasServer() const = 0;
    // The gateway itself is not reached.
    virtual bool isCut() const = 0;
    // Returns false while the gateway is not reached.
    virtual bool say(const gateway::FromGuest& message) = 0;
    // So the gateway is called: "wss://host:port".
    virtual std::string name() const = 0;
};

}  // namespace bonemill
