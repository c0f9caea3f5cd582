// A gateway behind NAT cannot be dialled: it dials out to this relay, which passes the guests' bytes on. It
// sees nothing but TLS between guest and gateway. One relay serves one gateway.
//
// One thread. What strangers can take is bounded: lines, lines of one address, time until a line says what it
// is, bytes that wait (RelayBounds).
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/log/log.h"
#include "common/tcp/descriptor.h"
#include "common/tcp/listen.h"
#include "render_client/web/relay/relay_greeting.h"

namespace bonemill {

struct RelayBounds {
    size_t lines = 2200;                        // two for each of 1000 guests, and strangers
    size_t lines_of_address = 1200;             // a class behind one NAT
    size_t new_of_address = 32;                 // that have not said yet what they are
    size_t waiting_guests = 64;                 // for their gateway
    size_t bytes_under_way = size_t(64) << 10;  // per line
    std::chrono::milliseconds to_greet{5000};
    std::chrono::milliseconds to_meet{10000};  // a guest its gateway
    std::chrono::milliseconds ping{10000};     // of the gateway; after three it is gone
    std::chrono::milliseconds to_close{2000};  // a line whose other half has ended
};

class Relay {
  public:
    // Listens, there or where `listener` already does. Throws UserError.
    explicit Relay(const RelayOptions& options, const RelayBounds& bounds = {}, Descriptor listener = {});
    ~Relay();

    uint16_t port() const noexcept { return port_; }
    // Serves until `should_stop`, which is asked ten times per second at least.
    void run(const std::function<bool()>& should_stop);

    struct Counts {
        size_t lines = 0;
        size_t guests = 0;  // that reach the gateway
        bool has_gateway = false;
        uint64_t refused = 0;
        uint64_t bytes = 0;  // passed on
    };
    // For the thread of run(), or after it.
    Counts counts() const;

  private:
    using Clock = std::chrono::steady_clock;
    enum class Stage { kNew, kGreeting, kProof, kControl, kWaiting, kPassing, kFarewell };
    struct Line;

    void acceptAll();
    bool isRefused(const PeerAddress& address) const;
    void serve(Line& line, uint32_t events);
    void learnKind(Line& line);
    void addGuest(Line& line);
    bool readGreeting(Line& line, size_t bytes);
    void challenge(Line& line);
    void takeProof(Line& line);
    void takePongs(Line& line);
    void join(Line& gateway_side, const GuestId& guest);
    void pass(Line& line);
    void bidFarewell(Line& line);
    void drop(Line& line);
    void say(Line& line, std::string_view bytes);
    void flush(Line& line);
    void watch(Line& line);
    void end(Line& line);
    void bury();
    void look(Clock::time_point now);

    RelayOptions options_;
    RelayBounds bounds_;
    uint16_t port_ = 0;
    Descriptor listener_, epoll_;
    std::map<int, std::unique_ptr<Line>> lines_;  // by descriptor
    std::vector<std::unique_ptr<Line>> ended_;    // until no event of the round can name them
    std::map<GuestId, Line*> waiting_;
    Line* control_ = nullptr;
    uint64_t refused_ = 0, bytes_ = 0;
    LogLimit wrong_secrets_;
    Clock::time_point looked_{}, pinged_{};
};

}  // namespace bonemill
