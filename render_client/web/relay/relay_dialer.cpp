#include "render_client/web/relay/relay_dialer.h"

#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>
#include <vector>

#include "common/tcp/dial.h"

namespace bonemill {
namespace {

constexpr size_t kMaxDials = 32;  // at once
constexpr size_t kMaxAskedGuests = 1024;
constexpr std::chrono::seconds kToAnswer{5}, kToBeAccepted{10}, kToBePinged{30};
constexpr int kDialRound_ms = 200;

bool sayAll(int socket, std::string_view bytes) {
    return send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL) == ssize_t(bytes.size());
}

}  // namespace

RelayDialer::RelayDialer(RelayPlace relay, Adopt adopt)
    : relay_(std::move(relay)),
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
        for (; control_ && !asked_.empty() && dials_.size() < kMaxDials; asked_.pop_front())
            beginGuest(asked_.front(), now);
    }
}

// Without a control line there is nothing else to do, so this may wait.
void RelayDialer::beginControl(Clock::time_point now) {
    const bool is_dialled =
        std::any_of(dials_.begin(), dials_.end(), [](const Dial& d) { return d.ask == RelayAsk::kControl; });
    if (control_ || is_dialled || now < next_try_) return;
    Dialled dialled = dial(relay_.host, relay_.port, kToAnswer, wake_.get());
    const auto later = Clock::now();
    next_try_ = later + pause_;
    pause_ = std::min(2 * pause_, kLongestPause);
    if (!dialled.socket) return complain(dialled.problem);
    dials_.push_back(
        {std::move(dialled.socket), RelayAsk::kControl, {}, Stage::kConnecting, {}, later + kToBeAccepted});
}

void RelayDialer::complain(const std::string& problem) {
    if (std::exchange(complaint_, problem) != problem)
        spdlog::warn("the relay {}:{}: {}; it is tried again and again", relay_.host, relay_.port, problem);
}

void RelayDialer::loseControl(Clock::time_point now) {
    complain("is lost");
    control_ = {};
    heard_.clear();
    asked_.clear();
    is_connected_ = false;
    pause_ = kShortestPause;
    next_try_ = now + pause_;
}

// The line goes to the very relay that has announced the guest, whatever its name stands for by now.
void RelayDialer::beginGuest(const AskedGuest& guest, Clock::time_point now) {
    Descriptor socket = beginDialAsOf(control_.get());
    if (!socket) return;
    dials_.push_back(
        {std::move(socket), RelayAsk::kGuest, guest, Stage::kConnecting, {}, now + kToBeAccepted});
}

RelayDialer::Progress RelayDialer::advance(Dial& dial) {
    const std::string greeting = greetingOf(dial.ask, dial.guest.id);
    if (dial.stage == Stage::kConnecting) {
        if (!hasConnected(dial.socket.get()) || !sayAll(dial.socket.get(), greeting))
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
    const RelayProof proof = proofOf(relay_.secret, greeting, nonce);
    return sayAll(dial.socket.get(), {proof.data(), proof.size()}) ? Progress::kGoesOn : Progress::kFailed;
}

void RelayDialer::settle(Dial& dial, Progress progress, Clock::time_point now) {
    if (progress == Progress::kGoesOn) return;
    const bool is_done = progress == Progress::kDone;
    if (dial.ask == RelayAsk::kGuest) {
        if (is_done) adopt_(std::move(dial.socket), dial.guest.address);
        return;
    }
    if (is_done) return beControl(std::move(dial.socket), now);
    complain(dial.stage == Stage::kAnswer ? "does not accept this gateway: both must have the same secret"
                                          : "is no relay");
}

void RelayDialer::beControl(Descriptor socket, Clock::time_point now) {
    spdlog::info("guests reach this gateway at the relay {}:{}", relay_.host, relay_.port);
    complaint_.clear();
    control_ = std::move(socket);
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
        AskedGuest guest;
        if (heard_.size() < kGuestCameBytes) return true;
        const auto id = heard_.begin() + 1, address = id + std::ptrdiff_t(guest.id.size());
        std::copy_n(id, guest.id.size(), guest.id.begin());
        std::copy_n(address, guest.address.size(), guest.address.begin());
        heard_.erase(0, kGuestCameBytes);
        if (asked_.size() < kMaxAskedGuests) asked_.push_back(guest);
    }
    return true;
}

}  // namespace bonemill
