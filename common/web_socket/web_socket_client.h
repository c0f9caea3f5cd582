// The client's side of a WebSocket (RFC 6455): whole messages go in and out. One thread uses it at a time; it
// never waits but while it connects and in wait(). Not RT-safe.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

#include "common/web_socket/web_line.h"

namespace bonemill {

struct WebSocketRequest {
    std::string path = "/";
    std::string protocol = {};  // the subprotocol; empty: none
    std::string origin = {};    // of a page; other clients name none
    bool is_text = false;       // what its messages are; else bytes
    // What the user is told of a server that does not open it.
    std::string refusal = "no WebSocket is there";
};

class WebSocketClient {
  public:
    static constexpr size_t kMaxMessageBytes = 80u << 20;  // a scene's tool and pictures, many times over

    // Throws UserError, which begins with the place.
    WebSocketClient(const WebTarget& target, const WebSocketRequest& request,
                    std::chrono::milliseconds patience);

    // The others do not throw (but std::bad_alloc). Queues a message.
    void send(std::string_view message);
    // Moves what can be moved.
    void move();
    // Takes the next whole message that has come; false: there is none.
    bool receive(std::string& message);
    // Ended by the other side, the network, or a message that is none; and all that came before was received.
    bool hasEnded() const noexcept { return has_ended_ && messages_.empty(); }
    bool hasUnsent() const noexcept { return !outgoing_.empty(); }
    // Waits until something can be moved, or `wake` (a file, or -1) can be read.
    void wait(int wake, std::chrono::nanoseconds patience) { line_.wait(hasUnsent(), wake, patience); }

  private:
    void shakeHands(const WebTarget& target, const WebSocketRequest& request,
                    std::chrono::steady_clock::time_point end);
    void queueFrame(unsigned char opcode, std::string_view payload);
    bool takeFrame();
    bool isFrame(unsigned char first, uint64_t size) const;
    void takePayload(unsigned char opcode, bool is_last, std::string_view payload);

    WebLine line_;
    const unsigned char opcode_;  // of its messages
    std::string incoming_;
    size_t taken_ = 0;  // of incoming_
    std::string outgoing_;
    std::string partial_;
    bool is_partial_ = false;  // a message's first part has come, its last not
    std::deque<std::string> messages_;
    bool has_ended_ = false;
};

}  // namespace bonemill
