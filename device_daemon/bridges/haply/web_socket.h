// A WebSocket client for text messages, on libwebsockets.
//
// One thread uses it at a time. Nothing but the constructor throws; it allocates.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace bonemill::bridge {

class WebSocket {
  public:
    // Connects within a few seconds. Throws UserError.
    WebSocket(const std::string& host, uint16_t port);
    ~WebSocket();

    bool isOpen() const noexcept;
    // Puts a message into the socket; false if it is closed, or did not take it within a moment.
    bool send(const std::string& message);
    // Waits for a whole message until the deadline (CLOCK_MONOTONIC ns); false if none has come.
    bool receive(std::string& message, int64_t deadline_ns);

  private:
    struct Connection;
    std::unique_ptr<Connection> connection_;
};

}  // namespace bonemill::bridge
