// What the other side of a WebSocket may do to its client.
#include "common/web_socket/web_socket_client.h"

#include <gtest/gtest.h>
#include <openssl/evp.h>
#include <openssl/sha.h>
#include <poll.h>

#include <optional>
#include <random>
#include <string>
#include <thread>

#include "common/tcp/listen.h"
#include "tests/support/mutated_bytes.h"

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
    EXPECT_FALSE(client.hasEnded()) << "there is something to receive";
    std::string message;
    ASSERT_TRUE(client.receive(message));
    EXPECT_EQ(message, "you must go");
    client.move();
    EXPECT_TRUE(client.hasEnded());
}

// RFC 6455, 5.2, 5.4, 5.5. Behind each comes as much more as the line takes.
TEST(WebSocketClient, EndsAtWhatIsNoFrame) {
    const std::string long_head("\x82\x7f\0\0\0\0\x10\0\0\0", 10);  // 256 MiB
    const std::pair<const char*, std::string> wrongs[] = {
        {"nothing to continue", frameOf(0x80, "a")},
        {"a message within a message", frameOf(0x02, "a") + frameOf(0x82, "b")},
        {"another kind than was asked for", frameOf(0x81, "text")},
        {"a reserved bit", frameOf(0xc2, "a")},
        {"a reserved opcode", frameOf(0x83, "a")},
        {"a reserved control opcode", frameOf(0x8b, "a")},
        {"a ping in parts", frameOf(0x09, "a")},
        {"a ping that is too long", std::string("\x89\x7e\0\x7e", 4) + std::string(126, 'a')},
        {"a mask", std::string("\x82\x81\0\0\0\0a", 7)},
        {"a message that is too long", long_head},
        {"a close", frameOf(0x88, "\x03\xe8")}};
    for (const auto& [what, bytes] : wrongs) {
        StandIn server;
        server.say(frameOf(0x82, "before") + bytes + frameOf(0x82, std::string(100, 'x')));
        std::string all, message;
        for (int n = 0; n < 100 && !server.client->hasEnded(); ++n) {
            server.client->wait(-1, std::chrono::milliseconds(100));
            server.client->move();
            while (server.client->receive(message)) all += message;
        }
        EXPECT_TRUE(server.client->hasEnded()) << what;
        EXPECT_EQ(all, "before") << what;
    }
}

TEST(WebSocketClient, MutatedFramesEndOrPassAndNothingElse) {
    std::mt19937 random(32);
    const std::string genuine = frameOf(0x02, "one ") + frameOf(0x00, "two ") + frameOf(0x89, "ping") +
                                frameOf(0x80, "three") + frameOf(0x82, std::string(120, 'b')) +
                                std::string("\x82\x7e\0\x80", 4) + std::string(128, 'c');
    for (int n = 0; n < 300; ++n) {
        StandIn server;
        for (int burst = 0; burst < 5; ++burst) server.say(test::mutated(genuine, random));
        server.hangUp();
        std::string message;
        for (int looks = 0; looks < 100 && !server.client->hasEnded(); ++looks) {
            server.client->wait(-1, std::chrono::milliseconds(100));
            server.client->move();
            while (server.client->receive(message)) EXPECT_LE(message.size(), 5 * genuine.size());
        }
        ASSERT_TRUE(server.client->hasEnded()) << n;
    }
}

}  // namespace
}  // namespace bonemill
