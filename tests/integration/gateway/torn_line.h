// A TLS line to the gateway whose bytes go out as torn as a test wants them: in parts of records, with or
// without an end, from any address of this PC.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <openssl/ssl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <random>
#include <string>

#include "common/tcp/descriptor.h"

namespace bonemill::gateway {

class TornLine {
  public:
    // `from` counts the addresses 127.0.0.1, 127.0.0.2 ...
    TornLine(uint16_t port, uint32_t from) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in here{}, there{};
        here.sin_family = there.sin_family = AF_INET;
        here.sin_addr.s_addr = htonl(INADDR_LOOPBACK + from);
        there.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        there.sin_port = htons(port);
        const int on = 1;
        setsockopt(socket_.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
        bind(socket_.get(), reinterpret_cast<sockaddr*>(&here), sizeof here);
        has_ended_ = connect(socket_.get(), reinterpret_cast<sockaddr*>(&there), sizeof there) != 0;
        SSL_set_bio(ssl_.get(), in_, out_);
        SSL_set_connect_state(ssl_.get());
        for (int n = 0; n < 200 && !has_ended_ && SSL_do_handshake(ssl_.get()) != 1; ++n) {
            flush();
            take(50);
        }
        flush();
    }

    // Enciphers it; nothing goes out before flush() or tear().
    void write(const std::string& bytes) {
        if (!has_ended_ && !bytes.empty()) SSL_write(ssl_.get(), bytes.data(), int(bytes.size()));
    }
    void flush() { send(enciphered()); }
    // Sends in parts, and keeps the last bytes for ever if it is not `whole`.
    void tear(std::mt19937& random, bool whole) {
        std::string bytes = enciphered();
        if (!whole && !bytes.empty()) bytes.resize(random() % bytes.size());
        for (size_t at = 0; at < bytes.size() && !has_ended_;) {
            const size_t size = std::min<size_t>(1 + random() % (1 + bytes.size() / 2), bytes.size() - at);
            send(bytes.substr(at, size));
            at += size;
            if (random() % 4 == 0) take(1);
        }
    }
    // Bytes that are no TLS.
    void writeRaw(const std::string& bytes) { send(bytes); }
    // Reads what comes within so many ms, and returns it deciphered.
    std::string read(int patience_ms) {
        take(patience_ms);
        std::string text;
        char bytes[16384];
        for (int came = 1; came > 0;) {
            came = SSL_read(ssl_.get(), bytes, sizeof bytes);
            if (came > 0) text.append(bytes, size_t(came));
        }
        flush();
        return text;
    }
    void reset() {
        const linger now{1, 0};
        setsockopt(socket_.get(), SOL_SOCKET, SO_LINGER, &now, sizeof now);
        socket_ = {};
    }
    bool hasEnded() const { return has_ended_; }

  private:
    std::string enciphered() {
        std::string bytes(BIO_ctrl_pending(out_), '\0');
        if (!bytes.empty()) BIO_read(out_, bytes.data(), int(bytes.size()));
        return bytes;
    }
    void send(const std::string& bytes) {
        for (size_t at = 0; at < bytes.size() && !has_ended_;) {
            const ssize_t sent =
                ::send(socket_.get(), bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL | MSG_DONTWAIT);
            if (sent > 0) at += size_t(sent);
            if (sent >= 0) continue;
            pollfd look{socket_.get(), POLLOUT, 0};
            if (errno != EAGAIN || poll(&look, 1, 1000) != 1) has_ended_ = true;  // nobody takes it
        }
    }
    void take(int patience_ms) {
        pollfd look{socket_.get(), POLLIN, 0};
        char bytes[65536];
        while (!has_ended_ && poll(&look, 1, patience_ms) == 1) {
            const ssize_t came = recv(socket_.get(), bytes, sizeof bytes, MSG_DONTWAIT);
            if (came <= 0) has_ended_ = came == 0 || errno != EAGAIN;
            if (came <= 0) return;
            BIO_write(in_, bytes, int(came));
            patience_ms = 0;
        }
    }

    static SSL_CTX* context() {
        static SSL_CTX* const kContext = SSL_CTX_new(TLS_client_method());
        return kContext;
    }

    Descriptor socket_;
    const std::unique_ptr<SSL, decltype(&SSL_free)> ssl_{SSL_new(context()), SSL_free};
    BIO* const in_ = BIO_new(BIO_s_mem());  // the connection's
    BIO* const out_ = BIO_new(BIO_s_mem());
    bool has_ended_ = false;
};

}  // namespace bonemill::gateway
