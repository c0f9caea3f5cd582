// What the other side of a WebSocket may do to its client.
#include "common/web_socket/web_socket_client.h"

#include <gtest/gtest.h>
#include <openssl/evp.h>
#include <openssl/sha.h>
#include <poll.h>

#include <string>
#include <thread>

#include "common/tcp/listen.h"

namespace bonemill {
namespace {

using std::chrono::seconds;

std::string acceptFor(const std::string& request) {
    const std::string name = "Sec-WebSocket-Key: ";
    const size_t at = request.find(name) + name.size();
    const std::string key = request.substr(at, request.find("\r\n", at) - at);
    const std::string text = key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";
    unsigned char hash[SHA_DIGEST_LENGTH], accept[64];
    SHA1(reinterpret_cast<const unsigned char*>(text.data()), text.size(), hash);
    EVP_EncodeBlock(accept, hash, sizeof hash);
    return reinterpret_cast<const char*>(accept);
}

// A server for one client, which says whatever it is told to.
class StandIn {
  public:
    StandIn() : listener_(listenOn("127.0.0.1", 0)) {
        std::thread answers([this] { answer(); });
        client.emplace(WebTarget{.host = "127.0.0.1", .port = portOf(listener_.get()), .is_plain = true},
                       WebSocketRequest{}, seconds(10));
        answers.join();
    }
    void say(const std::string& bytes) {
        ASSERT_EQ(send(line_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL), ssize_t(bytes.size()));
    }
    void waitForInput() const {
        pollfd look{line_.get(), POLLIN, 0};
        ASSERT_EQ(poll(&look, 1, 10'000), 1);
    }
    void hangUp() { line_ = {}; }

    std::optional<WebSocketClient> client;

  private:
    void answer() {
        pollfd look{listener_.get(), POLLIN, 0};
        poll(&look, 1, 10'000);
        PeerAddress from;
        line_ = acceptFrom(listener_.get(), from);
        std::string request;
        for (char bytes[1024]; request.find("\r\n\r\n") == std::string::npos;) {
            look = {line_.get(), POLLIN, 0};
            if (poll(&look, 1, 10'000) != 1) return;
            const ssize_t came = recv(line_.get(), bytes, sizeof bytes, 0);
            if (came <= 0) return;
            request.append(bytes, size_t(came));
        }
        say("HTTP/1.1 101 Switching Protocols\r\nSec-WebSocket-Accept: " + acceptFor(request) + "\r\n\r\n");
    }

    Descriptor listener_, line_;
};

std::string frameOf(unsigned char first, const std::string& payload) {
    return std::string{char(first), char(payload.size())} + payload;
}

TEST(WebSocketClient, HearsWhatWasSaidBeforeTheOtherSideHungUp) {
    StandIn server;
    WebSocketClient& client = *server.client;
    client.send("something that nobody reads");
    client.move();
    server.waitForInput();
    server.say(frameOf(0x82, "you must go"));
    server.hangUp();  // a reset, as there is unread input
    client.wait(-1, seconds(10));
    client.send("more");
    client.move();
    std::string message;
    ASSERT_TRUE(client.receive(message));
    EXPECT_EQ(message, "you must go");
    client.move();
    EXPECT_TRUE(client.hasEnded());
}

}  // namespace
}  // namespace bonemill
