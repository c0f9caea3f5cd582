// A TLS connection to a gateway, whose certificate is proven: by the system's authorities, or by its
// fingerprint. One thread uses it at a time. It never waits but while it connects.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace bonemill::connect {

struct TlsTarget {
    std::string host;
    uint16_t port = 443;
    std::string
        fingerprint;  // SHA-256 of the certificate's DER, 64 hexadecimal digits; empty: by authorities
};

class TlsSocket {
  public:
    // Throws UserError: nobody answers in time, or it is somebody else; then the message has the fingerprint.
    TlsSocket(const TlsTarget& target, std::chrono::milliseconds patience);
    ~TlsSocket();
    TlsSocket(const TlsSocket&) = delete;
    TlsSocket& operator=(const TlsSocket&) = delete;

    // Return how many bytes were moved, maybe 0; -1: the connection has ended.
    long read(char* bytes, size_t most);
    long write(const char* bytes, size_t size);
    // Waits until something can be read, or written if that is wanted, or `wake` (a file, or -1) can be read.
    void wait(bool wants_to_write, int wake, std::chrono::milliseconds patience);
    int descriptor() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace bonemill::connect
