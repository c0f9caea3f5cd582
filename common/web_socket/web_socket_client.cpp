#include "common/web_socket/web_socket_client.h"

#include <openssl/evp.h>
#include <openssl/rand.h>
#include <openssl/sha.h>

#include <algorithm>
#include <array>
#include <utility>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

constexpr unsigned char kContinuation = 0, kText = 1, kBinary = 2, kClose = 8, kPing = 9, kPong = 10,
                        kLast = 0x80;
constexpr unsigned char kReserved = 0x70, kOpcode = 0x0f;
constexpr uint64_t kMaxControl = 125;   // bytes (RFC 6455, 5.5)
constexpr size_t kMaxUntaken = 64;      // messages; then the network waits
constexpr size_t kMaxAtOnce = 8 << 20;  // bytes that one move() reads: whoever sends without end gets no more
constexpr size_t kMaxUnsent = 1 << 20;  // bytes, with which no ping is answered
constexpr size_t kMaxAnswer = 8192;     // bytes of the handshake's answer

std::string base64(const unsigned char* bytes, int size) {
    std::string text(size_t(4 * ((size + 2) / 3)) + 1, '\0');
    text.resize(size_t(EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), bytes, size)));
    return text;
}

std::string acceptOf(const std::string& key) {
    const std::string text = key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";  // RFC 6455, 1.3
    unsigned char hash[SHA_DIGEST_LENGTH];
    SHA1(reinterpret_cast<const unsigned char*>(text.data()), text.size(), hash);
    return base64(hash, sizeof hash);
}

std::string lowered(std::string text) {
    for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

}  // namespace

WebSocketClient::WebSocketClient(const WebTarget& target, const WebSocketRequest& request,
                                 std::chrono::milliseconds patience)
    : line_(target, patience), opcode_(request.is_text ? kText : kBinary) {
    shakeHands(target, request, std::chrono::steady_clock::now() + patience);
}

void WebSocketClient::shakeHands(const WebTarget& target, const WebSocketRequest& request,
                                 std::chrono::steady_clock::time_point end) {
    unsigned char random[16];
    if (RAND_bytes(random, sizeof random) != 1) throw UserError("library: OpenSSL has no random numbers");
    const std::string key = base64(random, sizeof random);
    const bool is_v6 = target.host.find(':') != std::string::npos;
    const std::string host = is_v6 ? "[" + target.host + "]" : target.host;
    const auto header = [](const char* name, const std::string& value) {
        return value.empty() ? "" : name + (": " + value) + "\r\n";
    };
    outgoing_ = "GET " + request.path + " HTTP/1.1\r\n" +
                header("Host", host + ":" + std::to_string(target.port)) +
                "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n" +
                header("Sec-WebSocket-Protocol", request.protocol) + header("Sec-WebSocket-Key", key) +
                header("Origin", request.origin) + "\r\n";
    size_t head = std::string::npos;
    while (!has_ended_ && head == std::string::npos && incoming_.size() < kMaxAnswer) {
        const auto left =
            std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
        if (left.count() <= 0) break;
        wait(-1, left);
        const long sent = line_.write(outgoing_.data(), outgoing_.size());
        std::array<char, 2048> bytes;
        const long came = line_.read(bytes.data(), bytes.size());
        has_ended_ = sent < 0 || came < 0;
        if (sent > 0) outgoing_.erase(0, size_t(sent));
        if (came > 0) incoming_.append(bytes.data(), size_t(came));
        head = incoming_.find("\r\n\r\n");
    }
    const std::string answer = incoming_.substr(0, head == std::string::npos ? 0 : head + 2);
    if (!answer.starts_with("HTTP/1.1 101") || answer.find(acceptOf(key)) == std::string::npos ||
        (!request.protocol.empty() &&
         lowered(answer).find("sec-websocket-protocol: " + request.protocol) == std::string::npos))
        throw UserError(target.place() + ": " + request.refusal);
    incoming_.erase(0, head + 4);
}

void WebSocketClient::send(std::string_view message) {
    queueFrame(opcode_, message);
}

void WebSocketClient::queueFrame(unsigned char opcode, std::string_view payload) {
    outgoing_ += char(kLast | opcode);
    const uint64_t size = payload.size();
    const int length_bytes = size < 126 ? 0 : size < 65536 ? 2 : 8;
    outgoing_ += char(0x80 | (length_bytes == 0 ? size : length_bytes == 2 ? 126 : 127));
    for (int n = length_bytes; n-- > 0;) outgoing_ += char(size >> (8 * n));
    unsigned char mask[4];
    if (RAND_bytes(mask, sizeof mask) != 1) has_ended_ = true;
    outgoing_.append(reinterpret_cast<const char*>(mask), sizeof mask);
    for (size_t n = 0; n < payload.size(); ++n) outgoing_ += char(payload[n] ^ char(mask[n % 4]));
}

void WebSocketClient::move() {
    bool is_broken = false;
    for (long sent = 1; sent > 0 && !outgoing_.empty();) {
        sent = line_.write(outgoing_.data(), outgoing_.size());
        is_broken = sent < 0;
        if (sent > 0) outgoing_.erase(0, size_t(sent));
    }
    // Who hangs up has often said why: what has come is there to be read, though nothing can be said any
    // more.
    std::array<char, 65536> bytes;
    size_t read = 0;
    for (long came = 1; came > 0 && !has_ended_ && messages_.size() < kMaxUntaken && read < kMaxAtOnce;) {
        came = line_.read(bytes.data(), bytes.size());
        if (came < 0 || (came == 0 && is_broken)) has_ended_ = true;
        if (came > 0) incoming_.append(bytes.data(), size_t(came)), read += size_t(came);
        while (takeFrame()) {
        }
        incoming_.erase(0, std::exchange(taken_, 0));
    }
}

// Returns false when no whole frame is there.
bool WebSocketClient::takeFrame() {
    const auto byte = [this](size_t n) {
        return uint64_t(static_cast<unsigned char>(incoming_[taken_ + n]));
    };
    const size_t there = incoming_.size() - taken_;
    if (there < 2) return false;
    uint64_t size = byte(1) & 0x7f;
    const size_t length_bytes = size == 126 ? 2 : size == 127 ? 8 : 0;
    if (there < 2 + length_bytes) return false;
    if (length_bytes > 0) {
        size = 0;
        for (size_t n = 0; n < length_bytes; ++n) size = size << 8 | byte(2 + n);
    }
    const auto first = static_cast<unsigned char>(byte(0));
    // A server masks nothing.
    if ((byte(1) & 0x80) != 0 || !isFrame(first, size) || size > kMaxMessageBytes ||
        partial_.size() + size > kMaxMessageBytes) {
        has_ended_ = true;
        return false;
    }
    if (there < 2 + length_bytes + size) return false;
    const std::string_view payload(incoming_.data() + taken_ + 2 + length_bytes, size_t(size));
    taken_ += 2 + length_bytes + size_t(size);
    takePayload(first & kOpcode, (first & kLast) != 0, payload);
    return !has_ended_;
}

// Returns whether a frame may begin so here (RFC 6455, 5.2, 5.4, 5.5); no extension was agreed on.
bool WebSocketClient::isFrame(unsigned char first, uint64_t size) const {
    const unsigned char opcode = first & kOpcode;
    if ((first & kReserved) != 0) return false;
    if (opcode >= kClose) return (first & kLast) != 0 && size <= kMaxControl;
    return (opcode == kContinuation) == is_partial_;
}

void WebSocketClient::takePayload(unsigned char opcode, bool is_last, std::string_view payload) {
    switch (opcode) {
        case kText:
        case kBinary:
            if (opcode != opcode_) break;
            [[fallthrough]];
        case kContinuation:
            partial_ += payload;
            is_partial_ = !is_last;
            if (is_last) messages_.push_back(std::exchange(partial_, {}));
            return;
        case kPing:
            if (outgoing_.size() < kMaxUnsent) queueFrame(kPong, payload);
            return;
        case kPong:
            return;
        default:
            break;
    }
    has_ended_ = true;
}

bool WebSocketClient::receive(std::string& message) {
    if (messages_.empty()) return false;
    message = std::move(messages_.front());
    messages_.pop_front();
    return true;
}

}  // namespace bonemill
