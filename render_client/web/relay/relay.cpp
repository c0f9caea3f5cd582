#include "render_client/web/relay/relay.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <spdlog/spdlog.h>
#include <sys/epoll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "common/secrets/secrets.h"
#include "common/tcp/listen.h"

namespace bonemill {

struct Relay::Line {
    Descriptor socket;
    PeerAddress address{};
    Stage stage = Stage::kNew;
    Clock::time_point until;  // it is ended then; that of kPassing is never
    std::string heard;        // of a gateway's greeting
    std::string greeting;
    RelayNonce nonce{};
    GuestId guest{};
    Line* partner = nullptr;
    std::string to_say;  // bounded by bytes_under_way
    bool ends_when_said = false;
    bool has_ended = false;
};

namespace {

constexpr int kMaxEvents = 64;
constexpr size_t kMaxRead = 16384;
constexpr size_t kMaxAccepted = 32;  // in one round: others are to be served, too
constexpr int kRound_ms = 100;
constexpr size_t kSpare = 32;        // descriptors
constexpr int kMaxWrongSecrets = 5;  // in the log at once, which strangers must not fill
constexpr int64_t kWrongSecretEvery_ns = 60'000'000'000;
constexpr auto kNever = std::chrono::steady_clock::time_point::max();

}  // namespace

Relay::Relay(const RelayOptions& options, const RelayBounds& bounds, Descriptor listener)
    : options_(options),
      bounds_(bounds),
      listener_(listener ? std::move(listener) : listenOn(options.address, options.port)),
      wrong_secrets_(kMaxWrongSecrets, kWrongSecretEvery_ns) {
    port_ = portOf(listener_.get());
    // Some are always left: a listener that cannot accept would be asked again and again.
    bounds_.lines = std::min(bounds_.lines, allowDescriptors(bounds_.lines + kSpare) - kSpare);
    epoll_ = Descriptor(epoll_create1(EPOLL_CLOEXEC));
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.ptr = nullptr;
    epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, listener_.get(), &event);
}

Relay::~Relay() = default;

void Relay::run(const std::function<bool()>& should_stop) {
    std::array<epoll_event, kMaxEvents> events;
    while (!should_stop()) {
        const int count = epoll_wait(epoll_.get(), events.data(), kMaxEvents, kRound_ms);
        for (int i = 0; i < count; ++i) {
            if (events[size_t(i)].data.ptr == nullptr) {
                acceptAll();
                continue;
            }
            Line& line = *static_cast<Line*>(events[size_t(i)].data.ptr);
            if (!line.has_ended) serve(line, events[size_t(i)].events);
        }
        bury();
        look(Clock::now());
        bury();
    }
}

void Relay::acceptAll() {
    for (size_t i = 0; i < kMaxAccepted; ++i) {
        PeerAddress address{};
        Descriptor socket = acceptFrom(listener_.get(), address);
        if (!socket) return;
        if (isRefused(address)) {
            ++refused_;
            continue;
        }
        const int number = socket.get();
        auto line = std::make_unique<Line>();
        line->socket = std::move(socket);
        line->address = address;
        line->until = Clock::now() + bounds_.to_greet;
        epoll_event event{};
        event.events = EPOLLIN;
        event.data.ptr = line.get();
        if (epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, number, &event) == 0) lines_[number] = std::move(line);
    }
}

bool Relay::isRefused(const PeerAddress& address) const {
    if (lines_.size() >= bounds_.lines) return true;
    size_t all = 0, fresh = 0;
    for (const auto& [number, line] : lines_) {
        if (line->address != address) continue;
        ++all;
        fresh +=
            line->stage == Stage::kNew || line->stage == Stage::kGreeting || line->stage == Stage::kProof;
    }
    return all >= bounds_.lines_of_address || fresh >= bounds_.new_of_address;
}

void Relay::serve(Line& line, uint32_t events) {
    if (events & EPOLLOUT) flush(line);
    if (line.has_ended) return;
    if (events & (EPOLLERR | EPOLLHUP)) return end(line);
    if (!(events & EPOLLIN)) return;
    switch (line.stage) {
        case Stage::kNew:
            return learnKind(line);
        case Stage::kGreeting:
            return challenge(line);
        case Stage::kProof:
            return takeProof(line);
        case Stage::kControl:
            return takePongs(line);
        case Stage::kWaiting:
            return;  // its bytes stay where they are
        case Stage::kPassing:
            return pass(line);
        case Stage::kFarewell:
            return drop(line);
    }
}

void Relay::learnKind(Line& line) {
    char first = 0;
    if (recv(line.socket.get(), &first, 1, MSG_PEEK) != 1) return end(line);
    if (static_cast<uint8_t>(first) == kTlsHandshakeByte) return addGuest(line);
    if (first != kRelayMagic.front()) return end(line);
    line.stage = Stage::kGreeting;
    challenge(line);
}

// The guest's bytes stay in the kernel until its gateway is there.
void Relay::addGuest(Line& line) {
    if (!control_ || waiting_.size() >= bounds_.waiting_guests) {
        ++refused_;
        return end(line);
    }
    fillRandom(line.guest.data(), line.guest.size());
    line.stage = Stage::kWaiting;
    line.until = Clock::now() + bounds_.to_meet;
    waiting_[line.guest] = &line;
    watch(line);
    std::string news(1, kGuestCame);
    news.append(line.guest.data(), line.guest.size()).append(line.address.data(), line.address.size());
    say(*control_, news);
}

// Returns true when N bytes are there.
bool Relay::readGreeting(Line& line, size_t bytes) {
    std::array<char, 64> buffer;
    const ssize_t count =
        recv(line.socket.get(), buffer.data(), std::min(buffer.size(), bytes - line.heard.size()), 0);
    if (count <= 0) {
        if (count == 0 || errno != EAGAIN) end(line);
        return false;
    }
    line.heard.append(buffer.data(), size_t(count));
    return line.heard.size() == bytes;
}

void Relay::challenge(Line& line) {
    if (!readGreeting(line, kGreetingBytes)) return;
    line.greeting = std::exchange(line.heard, {});
    const char ask = line.greeting[kRelayMagic.size()];
    if (!line.greeting.starts_with(kRelayMagic) ||
        (ask != char(RelayAsk::kControl) && ask != char(RelayAsk::kGuest)))
        return end(line);
    fillRandom(line.nonce.data(), line.nonce.size());
    line.stage = Stage::kProof;
    say(line, {line.nonce.data(), line.nonce.size()});
}

void Relay::takeProof(Line& line) {
    if (!readGreeting(line, std::tuple_size_v<RelayProof>)) return;
    const RelayProof proof = proofOf(options_.secret, line.greeting, line.nonce);
    if (!isSameSecret({proof.data(), proof.size()}, line.heard)) {
        ++refused_;
        if (wrong_secrets_.ask(std::chrono::nanoseconds(Clock::now().time_since_epoch()).count()) >= 0)
            spdlog::warn("{} does not know the relay's secret", textOf(line.address));
        return end(line);
    }
    if (line.greeting[kRelayMagic.size()] == char(RelayAsk::kGuest)) {
        GuestId guest;
        std::copy_n(line.greeting.end() - std::ptrdiff_t(guest.size()), guest.size(), guest.begin());
        return join(line, guest);
    }
    if (control_) end(*control_);  // the gateway came back before its old line was missed
    control_ = &line;
    line.stage = Stage::kControl;
    line.until = Clock::now() + 3 * bounds_.ping;
    spdlog::info("the gateway is there, from {}", textOf(line.address));
    say(line, {&kRelayAccepted, 1});
}

void Relay::takePongs(Line& line) {
    std::array<char, 256> buffer;
    const ssize_t count = recv(line.socket.get(), buffer.data(), buffer.size(), 0);
    if (count < 0 && errno == EAGAIN) return;
    if (count <= 0 ||
        std::any_of(buffer.begin(), buffer.begin() + count, [](char c) { return c != kRelayPing; }))
        return end(line);
    line.until = Clock::now() + 3 * bounds_.ping;
}

void Relay::join(Line& gateway_side, const GuestId& guest) {
    const auto found = waiting_.find(guest);
    if (found == waiting_.end()) return end(gateway_side);
    Line& guest_side = *found->second;
    waiting_.erase(found);
    guest_side.partner = &gateway_side;
    gateway_side.partner = &guest_side;
    for (Line* line : {&guest_side, &gateway_side}) {
        line->stage = Stage::kPassing;
        line->until = kNever;
    }
    spdlog::debug("a guest from {} reaches the gateway", textOf(guest_side.address));
    say(gateway_side, {&kRelayAccepted, 1});
    watch(guest_side);
    watch(gateway_side);
}

void Relay::pass(Line& line) {
    std::array<char, kMaxRead> buffer;
    Line* const partner = line.partner;
    if (!partner || partner->to_say.size() >= bounds_.bytes_under_way) return;
    const size_t most = std::min(buffer.size(), bounds_.bytes_under_way - partner->to_say.size());
    const ssize_t count = recv(line.socket.get(), buffer.data(), most, 0);
    if (count < 0 && errno == EAGAIN) return;
    if (count <= 0) return end(line);
    bytes_ += uint64_t(count);
    say(*partner, {buffer.data(), size_t(count)});
    if (!line.has_ended) watch(line);
}

// All is said: what this side still sends is read and dropped until it closes, too. A socket that is closed
// with unread input resets the line, and what was said last would be lost.
void Relay::bidFarewell(Line& line) {
    if (line.stage == Stage::kFarewell) return;
    line.stage = Stage::kFarewell;
    line.until = Clock::now() + bounds_.to_close;
    shutdown(line.socket.get(), SHUT_WR);
    watch(line);
}

void Relay::drop(Line& line) {
    std::array<char, kMaxRead> buffer;
    const ssize_t count = recv(line.socket.get(), buffer.data(), buffer.size(), 0);
    if (count == 0 || (count < 0 && errno != EAGAIN)) end(line);
}

void Relay::say(Line& line, std::string_view bytes) {
    // Only a control line can be told more than pass() allows for: one that does not read is gone.
    if (line.to_say.size() + bytes.size() > bounds_.bytes_under_way) return end(line);
    line.to_say += bytes;
    flush(line);
}

void Relay::flush(Line& line) {
    const bool was_full = line.to_say.size() >= bounds_.bytes_under_way;
    size_t said = 0;
    while (said < line.to_say.size()) {
        const ssize_t count =
            send(line.socket.get(), line.to_say.data() + said, line.to_say.size() - said, MSG_NOSIGNAL);
        if (count < 0 && errno == EAGAIN) break;
        if (count <= 0) return end(line);
        said += size_t(count);
    }
    line.to_say.erase(0, said);
    if (line.to_say.empty() && line.ends_when_said) return bidFarewell(line);
    watch(line);
    if (was_full && line.partner) watch(*line.partner);
}

void Relay::watch(Line& line) {
    const bool takes = line.stage != Stage::kWaiting && !line.ends_when_said &&
                       (!line.partner || line.partner->to_say.size() < bounds_.bytes_under_way);
    const bool reads = takes || line.stage == Stage::kFarewell;
    epoll_event event{};
    event.events = (reads ? uint32_t(EPOLLIN) : 0) | (line.to_say.empty() ? 0 : uint32_t(EPOLLOUT));
    event.data.ptr = &line;
    epoll_ctl(epoll_.get(), EPOLL_CTL_MOD, line.socket.get(), &event);
}

void Relay::end(Line& line) {
    if (line.has_ended) return;
    line.has_ended = true;
    if (&line == control_) {
        control_ = nullptr;
        spdlog::warn("the gateway is gone");
    }
    if (line.stage == Stage::kWaiting) waiting_.erase(line.guest);
    if (Line* const partner = std::exchange(line.partner, nullptr)) {
        partner->partner = nullptr;
        partner->ends_when_said = true;
        partner->until = Clock::now() + bounds_.to_meet;
        if (partner->to_say.empty()) {
            bidFarewell(*partner);
        } else {
            watch(*partner);
        }
    }
    const int number = line.socket.get();
    epoll_ctl(epoll_.get(), EPOLL_CTL_DEL, number, nullptr);
    const auto found = lines_.find(number);
    ended_.push_back(std::move(found->second));
    lines_.erase(found);
}

void Relay::bury() {
    ended_.clear();
}

// Ends who is late, and asks whether the gateway is still there.
void Relay::look(Clock::time_point now) {
    if (now - looked_ < std::chrono::milliseconds(kRound_ms)) return;
    looked_ = now;
    std::vector<Line*> late;
    for (const auto& [number, line] : lines_)
        if (line->until < now) late.push_back(line.get());
    for (Line* line : late) end(*line);
    if (control_ && now - pinged_ >= bounds_.ping) {
        pinged_ = now;
        say(*control_, {&kRelayPing, 1});
    }
}

Relay::Counts Relay::counts() const {
    const auto passing = std::count_if(lines_.begin(), lines_.end(),
                                       [](const auto& l) { return l.second->stage == Stage::kPassing; });
    return {lines_.size(), size_t(passing) / 2, control_ != nullptr, refused_, bytes_};
}

}  // namespace bonemill
