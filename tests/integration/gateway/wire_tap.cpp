#include "tests/integration/gateway/wire_tap.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <list>
#include <utility>
#include <vector>

#include "common/tcp/listen.h"

namespace bonemill::test {
namespace {

constexpr int kTapRound_ms = 20;

sockaddr_in placeOnLoopback(const std::string& address, uint16_t port) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    inet_pton(AF_INET, address.c_str(), &place.sin_addr);
    place.sin_port = htons(port);
    return place;
}

}  // namespace

WireTap::WireTap(uint16_t to, std::string from)
    : to_(to), from_(std::move(from)), listener_(listenOn("127.0.0.1", 0)), thread_([this] { run(); }) {}

WireTap::~WireTap() {
    should_stop_ = true;
    thread_.join();
}

uint16_t WireTap::port() const {
    return portOf(listener_.get());
}

std::string WireTap::heard() const {
    const std::lock_guard lock(mutex_);
    return heard_;
}

Descriptor WireTap::dialOut() const {
    Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    const sockaddr_in from = placeOnLoopback(from_, 0), to = placeOnLoopback("127.0.0.1", to_);
    if (bind(socket.get(), reinterpret_cast<const sockaddr*>(&from), sizeof from) != 0 ||
        ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0)
        return {};
    return socket;
}

void WireTap::run() {
    std::list<Wire> wires;
    while (!should_stop_) {
        std::vector<pollfd> waits{{listener_.get(), POLLIN, 0}};
        for (const Wire& wire : wires)
            for (const Descriptor* end : {&wire.near, &wire.far}) waits.push_back({end->get(), POLLIN, 0});
        poll(waits.data(), waits.size(), kTapRound_ms);
        size_t i = 1;
        for (auto wire = wires.begin(); wire != wires.end(); i += 2) {
            const bool is_good = (waits[i].revents == 0 || passOn(wire->near, wire->far)) &&
                                 (waits[i + 1].revents == 0 || passOn(wire->far, wire->near));
            wire = is_good ? std::next(wire) : wires.erase(wire);
        }
        PeerAddress ignored{};
        Descriptor near = waits[0].revents != 0 ? acceptFrom(listener_.get(), ignored) : Descriptor();
        Descriptor far = near ? dialOut() : Descriptor();
        if (far) wires.push_back({std::move(near), std::move(far)});
    }
}

bool WireTap::passOn(const Descriptor& source, const Descriptor& sink) {
    char bytes[16384];
    const ssize_t count = recv(source.get(), bytes, sizeof bytes, 0);
    if (count <= 0) return false;
    {
        const std::lock_guard lock(mutex_);
        heard_.append(bytes, size_t(count));
    }
    for (ssize_t said = 0; said < count;) {
        pollfd wait{sink.get(), POLLOUT, 0};
        poll(&wait, 1, kTapRound_ms);
        const ssize_t more = send(sink.get(), bytes + said, size_t(count - said), MSG_NOSIGNAL);
        if (more < 0 && errno != EAGAIN) return false;
        said += std::max<ssize_t>(more, 0);
        if (should_stop_) return false;
    }
    return true;
}

}  // namespace bonemill::test
