// Whoever is no guest, or a bad one, gets nothing and takes nothing from the others.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "common/base/user_error.h"
#include "common/tcp/listen.h"
#include "tests/integration/gateway/gateway_guest.h"

namespace bonemill::gateway {
namespace {

const std::string kGuestToken = "00112233445566778899aabbccddeeff";

std::string answerTo(const RunningGateway& gateway, const std::string& request) {
    WebLine socket(gateway.target(), std::chrono::seconds(5));
    socket.write(request.data(), request.size());
    std::string answer;
    for (int looks = 0; looks < 100; ++looks) {
        socket.wait(false, -1, std::chrono::milliseconds(20));
        char bytes[4096];
        const long came = socket.read(bytes, sizeof bytes);
        if (came < 0) break;
        answer.append(bytes, size_t(came));
        const size_t head = answer.find("\r\n\r\n");
        if (head != std::string::npos && (answer.size() > head + 4 || answer.find(" 101") < head)) break;
    }
    return answer;
}

std::string get(const std::string& path, const std::string& headers = {}) {
    return "GET " + path + " HTTP/1.1\r\nHost: there\r\n" + headers + "\r\n";
}

std::string upgrade(const std::string& path, const std::string& headers) {
    return get(path,
               "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
               "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n" +
                   headers);
}

TEST(GatewayPort, ServesThePageAndNothingElse) {
    const RunningGateway gateway("");
    const std::string index = answerTo(gateway, get("/"));
    EXPECT_TRUE(index.starts_with("HTTP/1.1 200")) << index;
    EXPECT_NE(index.find("<title>page</title>"), std::string::npos);
    EXPECT_NE(index.find("content-security-policy: default-src 'none'; script-src 'self'"),
              std::string::npos);
    EXPECT_NE(index.find("x-content-type-options: nosniff"), std::string::npos);
    EXPECT_NE(index.find("referrer-policy: no-referrer"), std::string::npos);
    EXPECT_NE(index.find("cache-control: no-store"), std::string::npos);
    const std::string script = answerTo(gateway, get("/main.js"));
    EXPECT_NE(script.find("content-type: text/javascript"), std::string::npos);
    EXPECT_TRUE(script.ends_with("let a = 1;")) << script;
    const std::string packed = answerTo(gateway, get("/main.js", "Accept-Encoding: br, gzip\r\n"));
    EXPECT_NE(packed.find("content-encoding: gzip"), std::string::npos);
    EXPECT_TRUE(packed.ends_with("packed"));
    for (const char* path : {"/../guests", "/..%2fguests", "//guests", "/main.js.gz", "/guests", "/session"})
        EXPECT_FALSE(answerTo(gateway, get(path)).starts_with("HTTP/1.1 200")) << path;
    EXPECT_TRUE(answerTo(gateway, "POST / HTTP/1.1\r\nHost: there\r\nContent-Length: 1\r\n\r\na")
                    .starts_with("HTTP/1.1 405"));
}

TEST(GatewayPort, OpensASessionOnlyForItsOwnPageAndForViewers) {
    const RunningGateway gateway("");
    const std::string protocol = "Sec-WebSocket-Protocol: bonemill.v1\r\n";
    EXPECT_TRUE(answerTo(gateway, upgrade("/session", protocol)).starts_with("HTTP/1.1 101")) << "a viewer";
    EXPECT_TRUE(answerTo(gateway, upgrade("/session", protocol + "Origin: https://there\r\n"))
                    .starts_with("HTTP/1.1 101"));
    EXPECT_TRUE(answerTo(gateway, upgrade("/session", protocol + "Origin: HTTPS://There:443\r\n"))
                    .starts_with("HTTP/1.1 101"))
        << "the default port may be named";
    for (const char* origin :
         {"https://elsewhere", "http://there", "null", "https://there.elsewhere", "https://there:444"})
        EXPECT_TRUE(answerTo(gateway, upgrade("/session", protocol + "Origin: " + origin + "\r\n"))
                        .starts_with("HTTP/1.1 403"))
            << origin;
    for (const std::string& request : {upgrade("/other", protocol), upgrade("/session", ""),
                                       upgrade("/session", "Sec-WebSocket-Protocol: http\r\n")})
        EXPECT_EQ(answerTo(gateway, request).find("HTTP/1.1 101"), std::string::npos) << request;
}

TEST(GatewayPort, AnswersWhatIsNoGetAsHttpWants) {
    const RunningGateway gateway("");
    const std::string end = "Host: there\r\nConnection: close\r\n\r\n";
    const std::string head = answerTo(gateway, "HEAD /main.js HTTP/1.1\r\n" + end);
    EXPECT_TRUE(head.starts_with("HTTP/1.1 200")) << head;
    EXPECT_NE(head.find("Content-Length: 10\r\n"), std::string::npos) << head;
    EXPECT_TRUE(head.ends_with("\r\n\r\n")) << "no body: " << head;
    for (const char* line :
         {"POST / HTTP/1.1\r\n", "CONNECT there:443 HTTP/1.1\r\n", "OPTIONS * HTTP/1.1\r\n"}) {
        const std::string answer = answerTo(gateway, line + end);
        EXPECT_TRUE(answer.starts_with("HTTP/1.1 405")) << line << answer;
        EXPECT_NE(answer.find("Allow: GET, HEAD\r\n"), std::string::npos) << line << answer;
    }
    const std::string old = answerTo(gateway, get("/session",
                                                  "Upgrade: websocket\r\nConnection: Upgrade\r\n"
                                                  "Sec-WebSocket-Version: 8\r\n"));
    EXPECT_TRUE(old.starts_with("HTTP/1.1 426")) << old;
    EXPECT_NE(old.find("Sec-WebSocket-Version: 13\r\n"), std::string::npos) << old;
    EXPECT_TRUE(answerTo(gateway, "GET / HTTP/1.1\r\nConnection: close\r\n\r\n").starts_with("HTTP/1.1 400"))
        << "without a host";
    EXPECT_TRUE(answerTo(gateway, "nonsense\r\n\r\n").starts_with("HTTP/1.1 400"));
    EXPECT_TRUE(answerTo(gateway, upgrade("/session", "Sec-WebSocket-Protocol: bonemill.v1\r\n") + "early")
                    .starts_with("HTTP/1.1 400"))
        << "frames before the answer";
}

TEST(GatewayPort, AnotherCertificateIsRefusedWithItsFingerprint) {
    const RunningGateway gateway("");
    WebTarget target = gateway.target();
    const std::string fingerprint = target.fingerprint;
    for (const char* wrong : {"", "00"}) {
        target.fingerprint = wrong;
        try {
            WebLine socket(target, std::chrono::seconds(5));
            ADD_FAILURE() << "'" << wrong << "' was accepted";
        } catch (const UserError& error) {
            EXPECT_NE(std::string(error.what()).find(fingerprint), std::string::npos) << error.what();
        }
    }
}

TEST(HostileGuest, FramesThatMakeNoSenseEndTheConnection) {
    TestServer server(3);
    const RunningGateway gateway(invitationOf("Class", "OPERATOR", kGuestToken, 0, 10) +
                                 invitationOf("Anna", "VIEWER", "anna"));
    TestGuest anna(gateway, "anna", true);
    ASSERT_TRUE(anna.isWelcome());
    const auto ends = [&](const std::string& what, const std::vector<std::string>& frames, bool says_hello) {
        TestGuest guest(gateway);
        if (says_hello) {
            guest.hello(kGuestToken);
            ASSERT_TRUE(guest.isWelcome()) << what;
        }
        for (const std::string& frame : frames) guest.socket.send(frame);
        EXPECT_TRUE(guest.pollUntil([&] { return guest.socket.hasEnded(); }, std::chrono::seconds(10)))
            << what;
        EXPECT_TRUE(guest.refusal) << what << ": is told why";
    };
    FromGuest received, command;
    received.mutable_received()->set_bytes(uint64_t(1) << 40);
    command.mutable_command()->set_reset_volume(true);
    command.mutable_command()->set_sequence(1);
    ends("noise instead of a hello", {"noise"}, false);
    ends("a command before the hello", {command.SerializeAsString()}, false);
    ends("noise", {std::string("\xff\xff\xff\xff", 4)}, true);
    ends("a frame that is too long", {std::string(20000, 'a')}, true);
    ends("bytes that never were sent", {received.SerializeAsString()}, true);
    ends("a flood", std::vector<std::string>(2000, command.SerializeAsString()), true);
    server.show({syntheticNode(1, 2)});
    const NodeDigest digest = server.publisher.digest();
    EXPECT_TRUE(anna.pollUntil([&] { return anna.digest() == digest; })) << "the others notice nothing";
}

TEST(HostileGuest, WhoGuessesIsSlowedDown) {
    const RunningGateway gateway(invitationOf("Anna", "VIEWER", "anna"));
    std::vector<std::unique_ptr<TestGuest>> guesses;
    const auto start = std::chrono::steady_clock::now();
    for (int n = 0; n < 12; ++n) {
        guesses.push_back(std::make_unique<TestGuest>(gateway, "guess " + std::to_string(n), true));
        guesses.back()->poll();
    }
    for (const auto& guess : guesses) ASSERT_TRUE(guess->isRefused());
    EXPECT_GT(std::chrono::steady_clock::now() - start, Guest::kRefusalDelay * 9 / 10);
    TestGuest late(gateway, "anna", true);
    ASSERT_TRUE(late.isRefused());
    EXPECT_NE(late.refusal->reason().find("wait a minute"), std::string::npos) << late.refusal->reason();
    EXPECT_FALSE(late.refusal->is_final());
}

// They come from so many addresses of their own, as in life.
std::vector<int> silentConnections(uint16_t port, int count, uint32_t addresses = 1) {
    std::vector<int> sockets;
    for (int n = 0; n < count; ++n) {
        const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        sockaddr_in from{}, to{};
        from.sin_family = to.sin_family = AF_INET;
        from.sin_addr.s_addr = htonl(INADDR_LOOPBACK + 1 + uint32_t(n) % addresses);
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        to.sin_port = htons(port);
        if (bind(socket, reinterpret_cast<sockaddr*>(&from), sizeof from) != 0 ||
            ::connect(socket, reinterpret_cast<sockaddr*>(&to), sizeof to) != 0)
            ADD_FAILURE() << "connection " << n;
        sockets.push_back(socket);
    }
    return sockets;
}

TEST(HostileGuest, OneAddressDoesNotTakeThePlacesOfAllOthers) {
    const RunningGateway gateway("");
    std::vector<std::unique_ptr<TestGuest>> silent;
    for (int n = 0; n < 20; ++n) silent.push_back(std::make_unique<TestGuest>(gateway));
    size_t open = 0;
    silent.back()->pollUntil([&] { return silent.back()->socket.hasEnded(); }, std::chrono::seconds(3));
    for (const auto& guest : silent) {
        guest->poll(std::chrono::milliseconds(0));
        open += !guest->socket.hasEnded();
    }
    EXPECT_EQ(open, Gateway::kMaxUnknown.of_address);
}

// Counts those that are still open, and closes all.
int closeAll(const std::vector<int>& sockets) {
    int open = 0;
    for (const int socket : sockets) {
        pollfd look{socket, POLLIN, 0};
        open += poll(&look, 1, 0) == 0;
        close(socket);
    }
    return open;
}

TEST(HostileGuest, AThousandSilentConnectionsAreBoundedAndKeepNobodyOut) {
    TestServer server(3);
    const RunningGateway gateway(invitationOf("Anna", "VIEWER", "anna", 0, 2));
    allowDescriptors(2000);
    for (const auto& [addresses, most_open] : {std::pair(1u, 96), std::pair(10u, 256)}) {
        const std::vector<int> silent = silentConnections(gateway.target().port, 1000, addresses);
        TestGuest anna(gateway, "anna", true);
        EXPECT_TRUE(anna.pollUntil([&] { return anna.isComplete(); }));
        EXPECT_LE(closeAll(silent), most_open) << "of " << addresses;
    }
}

TEST(HostileGuest, WhoSaysNoHelloMakesRoomForOthers) {
    GatewayOptions options;
    options.domain = testDomain();
    options.session = testSession();
    const test::TemporaryFolder folder;
    options.guests = folder / "guests";
    Gateway gateway(options);
    const auto now = Gateway::Clock::now();
    const auto come = [&](int address) { return gateway.come({"192.0.2." + std::to_string(address)}, now); };
    Guest* const first = come(1);
    for (size_t n = 1; n < Gateway::kMaxUnknown.all; ++n) ASSERT_TRUE(come(int(1 + n % 4)));
    EXPECT_FALSE(first->shouldClose(now));
    EXPECT_EQ(come(1), nullptr) << "it has its share";
    EXPECT_NE(come(9), nullptr);
    EXPECT_TRUE(first->shouldClose(now));
    EXPECT_TRUE(first->nextFrame(now).empty());
}

TEST(HostileGuest, WhoAcknowledgesNothingHarmsNobody) {
    TestServer server(200, 600);
    const RunningGateway gateway(invitationOf("Anna", "VIEWER", "anna") +
                                 invitationOf("Silent", "VIEWER", "silent"));
    TestGuest silent(gateway, "silent", false), anna(gateway, "anna", true);
    ASSERT_TRUE(silent.isWelcome());
    EXPECT_TRUE(anna.pollUntil([&] { return anna.isComplete() && anna.digest().count() == 200; }));
    for (int n = 0; n < 20; ++n) {
        server.publisher.publishToolState(syntheticTick(uint64_t(n)));
        silent.poll();
    }
    EXPECT_LT(silent.received, 200'000u) << "the window, and no more";
    EXPECT_GT(anna.received, silent.received);
    FromGuest received;
    received.mutable_received()->set_bytes(silent.received);
    silent.acknowledges = true;
    silent.send(received);
    EXPECT_TRUE(silent.pollUntil([&] { return silent.isComplete() && silent.digest().count() == 200; }));
}

}  // namespace
}  // namespace bonemill::gateway
