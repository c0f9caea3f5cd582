// A TCP line to a server on the web, plain or with TLS. With TLS the server's certificate is proven: by the
// system's authorities, or by its fingerprint. One thread uses it at a time. It never waits but while it
// connects and in wait(). Not RT-safe.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace bonemill {

struct WebTarget {
    std::string host;
    uint16_t port = 443;
    // SHA-256 of the certificate's DER, 64 hexadecimal digits; empty: by authorities
    std::string fingerprint = {};
    bool is_plain = false;  // without TLS

    std::string place() const { return host + ":" + std::to_string(port); }
};

class WebLine {
  public:
    // Throws UserError, which begins with the place: there is no answer in time, or another server answers;
    // then the message has the fingerprint.
    WebLine(const WebTarget& target, std::chrono::milliseconds patience);
    ~WebLine();
    WebLine(const WebLine&) = delete;
    WebLine& operator=(const WebLine&) = delete;

    // Return how many bytes were moved, maybe 0; -1: the connection has ended.
    long read(char* bytes, size_t most);
    long write(const char* bytes, size_t size);
    // Waits until something can be read, or written if that is wanted, or `wake` (a file, or -1) can be read.
    void wait(bool wants_to_write, int wake, std::chrono::nanoseconds patience);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace bonemill
