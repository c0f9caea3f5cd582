#include "render_client/relay/relay_dialer.h"

#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <vector>

#include "render_client/relay/dial.h"

namespace bonemill {
namespace {

constexpr size_t kMostDials = 32;  // at once
constexpr size_t kMostAskedGuests = 1024;
constexpr std::chrono::seconds kToBeAccepted{10}, kToBePinged{30};
constexpr int kDialRound_ms = 200;

bool sayAll(int socket, std::string_view bytes) {
    return send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL) == ssize_t(bytes.size());
}

bool isConnectedSocket(int socket) {
    int error = 0;
    socklen_t size = sizeof error;
    return getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size) == 0 && error == 0;
}

}  // namespace

RelayDialer::RelayDialer(RelayPlace relay, std::string secret, Adopt adopt)
    : relay_(std::move(relay)),
      secret_(std::move(secret)),
      adopt_(std::move(adopt)),
      wake_(eventfd(0, EFD_CLOEXEC)),
      thread_([this] { run(); }) {}

RelayDialer::~RelayDialer() {
    eventfd_write(wake_.get(), 1);
    thread_.join();
}

void RelayDialer::run() {
    while (true) {
        std::vector<pollfd> waits{{wake_.get(), POLLIN, 0}, {control_.get(), POLLIN, 0}};
        for (const Dial& dial : dials_)
            waits.push_back(
                {dial.socket.get(), short(dial.stage == Stage::kConnecting ? POLLOUT : POLLIN), 0});
        poll(waits.data(), waits.size(), kDialRound_ms);
        if (waits[0].revents != 0) return;
        const auto now = Clock::now();
        if (control_ && ((waits[1].revents != 0 && !hearControl(now)) || now - control_heard_ > kToBePinged))
            loseControl(now);
        size_t i = 2;
        for (auto dial = dials_.begin(); dial != dials_.end() && i < waits.size(); ++i) {
            const auto here = dial++;
            const Progress progress = waits[i].revents != 0 ? advance(*here)
                                      : now > here->until   ? Progress::kFailed
                                                            : Progress::kGoesOn;
            settle(*here, progress, now);
            if (progress != Progress::kGoesOn) dials_.erase(here);
        }
        beginControl(now);
        for (; !asked_.empty() && dials_.size() < kMostDials; asked_.pop_front())
            dial(RelayAsk::kGuest, asked_.front(), now);
    }
}

void RelayDialer::beginControl(Clock::time_point now) {
    const bool is_dialled =
        std::any_of(dials_.begin(), dials_.end(), [](const Dial& d) { return d.ask == RelayAsk::kControl; });
    if (control_ || is_dialled || now < next_try_) return;
    next_try_ = now + pause_;
    pause_ = std::min(2 * pause_, kLongestPause);
    dial(RelayAsk::kControl, {}, now);
}

void RelayDialer::loseControl(Clock::time_point now) {
    spdlog::warn("the relay {}:{} is lost; it is tried again", relay_.host, relay_.port);
    control_ = {};
    heard_.clear();
    asked_.clear();
    is_connected_ = false;
    pause_ = kShortestPause;
    next_try_ = now + pause_;
}

void RelayDialer::dial(RelayAsk ask, const GuestId& guest, Clock::time_point now) {
    Descriptor socket = beginDial(relay_.host, relay_.port);
    if (!socket) return;
    dials_.push_back({std::move(socket), ask, guest, Stage::kConnecting, {}, now + kToBeAccepted});
}

RelayDialer::Progress RelayDialer::advance(Dial& dial) {
    const std::string greeting = greetingOf(dial.ask, dial.guest);
    if (dial.stage == Stage::kConnecting) {
        if (!isConnectedSocket(dial.socket.get()) || !sayAll(dial.socket.get(), greeting))
            return Progress::kFailed;
        dial.stage = Stage::kNonce;
        return Progress::kGoesOn;
    }
    // What follows the answer is the guest's and stays in the socket.
    const size_t wanted = dial.stage == Stage::kNonce ? std::tuple_size_v<RelayNonce> : 1;
    std::array<char, std::tuple_size_v<RelayNonce>> buffer;
    const ssize_t count = recv(dial.socket.get(), buffer.data(), wanted - dial.heard.size(), 0);
    if (count < 0 && errno == EAGAIN) return Progress::kGoesOn;
    if (count <= 0) return Progress::kFailed;
    dial.heard.append(buffer.data(), size_t(count));
    if (dial.heard.size() < wanted) return Progress::kGoesOn;
    if (dial.stage == Stage::kAnswer)
        return dial.heard[0] == kRelayAccepted ? Progress::kDone : Progress::kFailed;
    RelayNonce nonce;
    std::copy(dial.heard.begin(), dial.heard.end(), nonce.begin());
    dial.heard.clear();
    dial.stage = Stage::kAnswer;
    const RelayProof proof = proofOf(secret_, greeting, nonce);
    return sayAll(dial.socket.get(), {proof.data(), proof.size()}) ? Progress::kGoesOn : Progress::kFailed;
}

void RelayDialer::settle(Dial& dial, Progress progress, Clock::time_point now) {
    if (progress == Progress::kGoesOn) return;
    const bool is_done = progress == Progress::kDone;
    if (dial.ask == RelayAsk::kGuest) {
        if (is_done) adopt_(std::move(dial.socket));
        return;
    }
    if (!is_done) {
        if (pause_ == kLongestPause || pause_ == 2 * kShortestPause)
            spdlog::warn("the relay {}:{} does not answer, or has another secret; it is tried again",
                         relay_.host, relay_.port);
        return;
    }
    spdlog::info("guests reach this gateway at the relay {}:{}", relay_.host, relay_.port);
    control_ = std::move(dial.socket);
    control_heard_ = now;
    pause_ = kShortestPause;
    is_connected_ = true;
}

bool RelayDialer::hearControl(Clock::time_point now) {
    std::array<char, 4096> buffer;
    const ssize_t count = recv(control_.get(), buffer.data(), buffer.size(), 0);
    if (count < 0 && errno == EAGAIN) return true;
    if (count <= 0) return false;
    control_heard_ = now;
    heard_.append(buffer.data(), size_t(count));
    while (!heard_.empty()) {
        if (heard_[0] == kRelayPing) {
            heard_.erase(0, 1);
            if (!sayAll(control_.get(), {&kRelayPing, 1})) return false;
            continue;
        }
        if (heard_[0] != kGuestCame) return false;
        GuestId guest;
        if (heard_.size() < 1 + guest.size()) return true;
        std::copy_n(heard_.begin() + 1, guest.size(), guest.begin());
        heard_.erase(0, 1 + guest.size());
        if (asked_.size() < kMostAskedGuests) asked_.push_back(guest);
    }
    return true;
}

}  // namespace bonemill
