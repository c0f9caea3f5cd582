// What comes to the port and is no guest's: other protocols, old TLS, bytes that drip, frames without end,
// noise.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <sys/socket.h>

#include <cerrno>
#include <memory>
#include <random>
#include <thread>

#include "common/tcp/dial.h"
#include "tests/integration/gateway/gateway_guest.h"
#include "tests/support/mutated_bytes.h"

namespace bonemill::gateway {
namespace {

using std::chrono::milliseconds;

constexpr char kUpgrade[] =
    "GET /session HTTP/1.1\r\nHost: there\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
    "Sec-WebSocket-Protocol: bonemill.v1\r\n\r\n";
// A frame's head, and a mask of zeros.
const std::string kWholeBinary("\x82\x80\0\0\0\0", 6), kFirstPart("\x02\x80\0\0\0\0", 6),
    kNextPart("\0\x80\0\0\0\0", 6), kPing("\x89\x80\0\0\0\0", 6);

Descriptor dialled(const RunningGateway& gateway) {
    Dialled dialled = dial("127.0.0.1", gateway.target().port, std::chrono::seconds(5));
    EXPECT_TRUE(dialled.socket) << dialled.problem;
    return std::move(dialled.socket);
}

// What somebody says behind the TLS handshake.
class Stranger {
  public:
    explicit Stranger(const RunningGateway& gateway) : socket_(gateway.target(), std::chrono::seconds(5)) {}
    // Returns false when the other side has ended.
    bool say(const std::string& bytes) {
        for (size_t at = 0; at < bytes.size() && !has_ended_;) {
            const long sent = socket_.write(bytes.data() + at, bytes.size() - at);
            if (sent < 0) has_ended_ = true;
            if (sent > 0) at += size_t(sent);
            if (sent == 0) listen(milliseconds(5));
        }
        listen(milliseconds(0));
        return !has_ended_;
    }
    void listen(milliseconds patience) {
        socket_.wait(false, -1, patience);
        char bytes[4096];
        const long came = socket_.read(bytes, sizeof bytes);
        if (came < 0) has_ended_ = true;
        if (came > 0) heard_.append(bytes, size_t(came));
    }
    bool upgrade() {
        say(kUpgrade);
        for (int looks = 0; looks < 500 && heard_.find("\r\n\r\n") == std::string::npos; ++looks)
            listen(milliseconds(10));
        return heard_.starts_with("HTTP/1.1 101");
    }
    bool hasEnded() const { return has_ended_; }
    const std::string& heard() const { return heard_; }

  private:
    WebLine socket_;
    std::string heard_;
    bool has_ended_ = false;
};

// Shakes hands with TLS up to this version, up to 1.2 with these suites alone, and returns OpenSSL's reason;
// 0: it speaks it.
int refusalOfTls(const RunningGateway& gateway, int version, const char* suites = "ALL") {
    using Context = std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)>;
    using Connection = std::unique_ptr<SSL, decltype(&SSL_free)>;
    const Descriptor socket = dialled(gateway);
    fcntl(socket.get(), F_SETFL, fcntl(socket.get(), F_GETFL) & ~O_NONBLOCK);
    const Context context(SSL_CTX_new(TLS_client_method()), SSL_CTX_free);
    SSL_CTX_set_security_level(context.get(), 0);  // this side takes everything
    SSL_CTX_set_min_proto_version(context.get(), TLS1_VERSION);
    SSL_CTX_set_max_proto_version(context.get(), version);
    EXPECT_EQ(SSL_CTX_set_cipher_list(context.get(), suites), 1);
    const Connection connection(SSL_new(context.get()), SSL_free);
    SSL_set_fd(connection.get(), socket.get());
    ERR_clear_error();
    if (SSL_connect(connection.get()) == 1) return 0;
    return ERR_GET_REASON(ERR_get_error());
}

TEST(GatewayPort, SpeaksNoTlsBefore12) {
    const RunningGateway gateway("");
    EXPECT_EQ(refusalOfTls(gateway, TLS1_VERSION), SSL_R_TLSV1_ALERT_PROTOCOL_VERSION) << "it says so itself";
    EXPECT_EQ(refusalOfTls(gateway, TLS1_1_VERSION), SSL_R_TLSV1_ALERT_PROTOCOL_VERSION);
    EXPECT_EQ(refusalOfTls(gateway, TLS1_2_VERSION), 0);
    EXPECT_EQ(refusalOfTls(gateway, TLS1_3_VERSION), 0);
    EXPECT_EQ(refusalOfTls(gateway, TLS1_2_VERSION, "ECDHE-ECDSA-AES128-SHA:ECDHE-ECDSA-AES256-SHA384"),
              SSL_R_SSLV3_ALERT_HANDSHAKE_FAILURE)
        << "of 1.2 no suite with CBC";
    EXPECT_EQ(refusalOfTls(gateway, TLS1_2_VERSION, "ECDHE-ECDSA-CHACHA20-POLY1305"), 0);
}

TEST(GatewayPort, PlainHttpGetsNoAnswer) {
    const RunningGateway gateway("");
    const Descriptor socket = dialled(gateway);
    const std::string request = "GET / HTTP/1.1\r\nHost: there\r\n\r\n";
    ASSERT_EQ(send(socket.get(), request.data(), request.size(), MSG_NOSIGNAL), ssize_t(request.size()));
    std::string answer;
    bool has_ended = false;
    EXPECT_TRUE(test::waitFor([&] {
        char bytes[1024];
        const ssize_t came = recv(socket.get(), bytes, sizeof bytes, MSG_DONTWAIT);
        if (came > 0) answer.append(bytes, size_t(came));
        has_ended = came == 0 || (came < 0 && errno != EAGAIN);
        return has_ended;
    }));
    EXPECT_EQ(answer.find("HTTP"), std::string::npos) << answer;
}

// Each says a byte now and then, so that something always comes.
TEST(HostileGuest, WhoDripsIsEnded) {
    TestServer server(3);
    const RunningGateway gateway(invitationOf("Anna", "VIEWER", "anna"));
    TestGuest anna(gateway, "anna", true);
    ASSERT_TRUE(anna.isWelcome());
    const Descriptor handshake = dialled(gateway);
    Stranger headers(gateway), hello(gateway), body(gateway);
    ASSERT_TRUE(hello.upgrade());
    ASSERT_TRUE(headers.say("GET / HTTP/1.1\r\n"));
    ASSERT_TRUE(hello.say(std::string("\x82\xfe\x10\0\0\0\0\0", 8)));  // of 4096 bytes
    body.say("POST / HTTP/1.1\r\nHost: there\r\nContent-Length: 1000000\r\n\r\n");
    const std::string client_hello("\x16\x03\x01\x02\0\x01\0\x01\xfc\x03\x03", 11);  // of 512 bytes
    size_t dripped = 0;
    bool is_handshake_over = false;
    EXPECT_TRUE(test::waitFor([&] {
        const char byte = dripped < client_hello.size() ? client_hello[dripped] : 'a';
        ++dripped;
        char answer[64];
        is_handshake_over = is_handshake_over || send(handshake.get(), &byte, 1, MSG_NOSIGNAL) != 1 ||
                            recv(handshake.get(), answer, sizeof answer, MSG_DONTWAIT) >= 0;
        headers.say(dripped % 2 != 0 ? "a" : ":");
        hello.say("a");
        body.say("a");
        std::this_thread::sleep_for(milliseconds(200));
        anna.poll(milliseconds(0));
        return is_handshake_over && headers.hasEnded() && hello.hasEnded() && body.hasEnded();
    })) << "handshake "
        << is_handshake_over << ", headers " << headers.hasEnded() << ", hello " << hello.hasEnded()
        << ", body " << body.hasEnded();
    EXPECT_FALSE(anna.socket.hasEnded());
}

// They never are a message. Who sends nothing else gets no more than a turn.
TEST(HostileGuest, PingsAndPartsWithoutBytesHarmNobody) {
    TestServer server(3);
    const RunningGateway gateway(invitationOf("Anna", "VIEWER", "anna"));
    Stranger pings(gateway), parts(gateway);
    ASSERT_TRUE(pings.upgrade() && parts.upgrade() && parts.say(kFirstPart));
    std::string many_pings, many_parts;
    for (int n = 0; n < 5000; ++n) many_pings += kPing, many_parts += kNextPart;
    TestGuest anna(gateway, "anna", true);
    EXPECT_TRUE(anna.pollUntil([&] {
        pings.say(many_pings);
        parts.say(many_parts);
        return anna.isComplete() && pings.hasEnded() && parts.hasEnded();
    })) << "who says no Hello is sent away";
    EXPECT_FALSE(anna.socket.hasEnded());
}

TEST(HostileGuest, NoiseOnThePortHarmsNobody) {
    TestServer server(3);
    const RunningGateway gateway(invitationOf("Anna", "VIEWER", "anna"));
    TestGuest anna(gateway, "anna", true);
    ASSERT_TRUE(anna.isWelcome());
    FromGuest received;
    received.mutable_received()->set_bytes(1);
    const std::string frames =
        kPing + kFirstPart + kNextPart + kWholeBinary + kPing +
        std::string("\x82\xff\x7f\xff\xff\xff\xff\xff\xff\xff\0\0\0\0", 14) +  // 2^63 bytes
        std::string("\x88\x82\0\0\0\0\x03\xe8", 8) + received.SerializeAsString();
    const std::vector<std::string> talks{
        kUpgrade + frames, std::string("GET /") + std::string(6000, 'a'),
        "GET / HTTP/1.1\r\nHost: there\r\nCookie: " + std::string(6000, 'a') + "\r\n\r\n",
        "POST /session HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\nffffffffffffffff\r\n" + frames};
    std::mt19937 random(18);
    for (int n = 0; n < 300; ++n) {
        Stranger stranger(gateway);
        const std::string& talk = talks[random() % talks.size()];
        // What is changed lies before, in or behind the headers.
        const size_t split = random() % talk.size();
        stranger.say(test::mutated(talk.substr(0, split), random));
        stranger.say(test::mutated(talk.substr(split), random));
        anna.poll(milliseconds(0));
    }
    server.show({syntheticNode(1, 2)});
    const NodeDigest digest = server.publisher.digest();
    EXPECT_TRUE(anna.pollUntil([&] { return anna.digest() == digest; }));
}

}  // namespace
}  // namespace bonemill::gateway
