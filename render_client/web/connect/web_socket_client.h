// The client's side of a WebSocket (RFC 6455) over TLS: whole binary messages go in and out. One thread uses
// it at a time; it never waits but while it connects.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

#include "render_client/web/connect/tls_socket.h"

namespace bonemill::connect {

class WebSocketClient {
  public:
    static constexpr size_t kMostMessageBytes = 80u << 20;  // a scene's tool and pictures, many times over

    // `origin` is for tests: viewers name none. Throws UserError.
    WebSocketClient(const TlsTarget& target, const std::string& path, const std::string& protocol,
                    std::chrono::milliseconds patience, const std::string& origin = {});

    // Queues a message.
    void send(std::string_view message);
    // Moves what can be moved.
    void move();
    // Takes the next whole message that has come; false: there is none.
    bool receive(std::string& message);
    // Ended by the other side, the network, or a message that is none.
    bool hasEnded() const noexcept { return has_ended_; }
    bool hasUnsent() const noexcept { return !outgoing_.empty(); }
    void wait(int wake, std::chrono::milliseconds patience) { socket_.wait(hasUnsent(), wake, patience); }

  private:
    void shakeHands(const TlsTarget& target, const std::string& path, const std::string& protocol,
                    const std::string& origin, std::chrono::steady_clock::time_point end);
    void queueFrame(unsigned char opcode, std::string_view payload);
    bool takeFrame();
    void takePayload(unsigned char opcode, bool is_last, std::string_view payload);

    TlsSocket socket_;
    std::string incoming_;
    size_t taken_ = 0;  // of incoming_
    std::string outgoing_;
    std::string partial_;
    std::deque<std::string> messages_;
    bool has_ended_ = false;
};

}  // namespace bonemill::connect
