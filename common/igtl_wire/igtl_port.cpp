#include "common/igtl_wire/igtl_port.h"

#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <utility>

#include "common/text/foreign_text.h"

namespace bonemill::igtl {
namespace {

constexpr size_t kPieceBytes = 16 << 10;  // of a peer, per step: others are to be heard, too
constexpr int kMostAccepted = 16;         // per step
constexpr int kKernelBytes = 256 << 10;   // that wait in the kernel: what is newest must not wait behind more

uint64_t nextNumber() {
    static std::atomic<uint64_t> newest{0};
    return ++newest;
}

bool isAgain(int error) {
    return error == EAGAIN || error == EWOULDBLOCK || error == EINTR;
}

}  // namespace

Line::Line(Descriptor socket, const PeerAddress& from, const std::vector<WantedType>& wanted,
           Clock::time_point now)
    : socket_(std::move(socket)),
      from_(from),
      number_(nextNumber()),
      reader_(wanted),
      whole_(now),
      progress_(now) {
    setUpLine(socket_.get());
    setsockopt(socket_.get(), SOL_SOCKET, SO_SNDBUF, &kKernelBytes, sizeof kKernelBytes);
}

bool Line::isOfThisPc() const noexcept {
    return isLoopback(textOf(from_));
}

bool Line::say(Blob frame, size_t most_waiting) {
    if (hasEnded() || waiting_bytes_ > most_waiting) {
        ++dropped_frames_;
        return false;
    }
    waiting_bytes_ += frame->size();
    waiting_.push_back(std::move(frame));
    return true;
}

void Line::refuse(const std::string& why) {
    if (end_.empty()) end_ = why;
}

void Line::hear(Clock::time_point now, const std::function<void(const Frame&)>& use) {
    std::array<char, kPieceBytes> piece;
    const ssize_t count = recv(socket_.get(), piece.data(), piece.size(), 0);
    if (count == 0) return refuse("it has left");
    if (count < 0) return isAgain(errno) ? void() : refuse("the line is lost");
    const uint64_t skipped = reader_.skippedFrames();
    const std::string complaint = reader_.take({piece.data(), size_t(count)}, [&](const Frame& frame) {
        ++heard_frames_;
        whole_ = now;
        if (!hasEnded()) use(frame);
    });
    if (!reader_.isWithin() || reader_.skippedFrames() != skipped) whole_ = now;
    if (!complaint.empty()) refuse("it sent " + complaint);
}

void Line::send(Clock::time_point now) {
    while (!waiting_.empty()) {
        const std::string& frame = *waiting_.front();
        const ssize_t count = ::send(socket_.get(), frame.data() + first_sent_, frame.size() - first_sent_,
                                     MSG_NOSIGNAL | MSG_DONTWAIT);
        if (count < 0) return isAgain(errno) ? void() : refuse("the line is lost");
        progress_ = now;
        sent_bytes_ += uint64_t(count);
        waiting_bytes_ -= size_t(count);
        first_sent_ += size_t(count);
        if (first_sent_ < frame.size()) return;
        first_sent_ = 0;
        waiting_.pop_front();
    }
    progress_ = now;
}

void Line::lookAfter(const PortBounds& bounds, Clock::time_point now) {
    if (!reader_.isWithin()) whole_ = now;
    if (now - whole_ > bounds.frame_time) refuse("it left a message unfinished");
    if (now - progress_ > bounds.read_time) refuse("it does not read");
}

Port::Port(const std::string& address, uint16_t port, std::vector<WantedType> wanted,
           const PortBounds& bounds, LineSink& sink)
    : wanted_(std::move(wanted)), bounds_(bounds), sink_(sink), listener_(listenOn(address, port)) {}

void Port::step(std::chrono::milliseconds patience) {
    std::vector<pollfd> files{{listener_.get(), POLLIN, 0}};
    for (const auto& line : lines_)
        files.push_back({line->socket_.get(), short(POLLIN | (line->waiting_.empty() ? 0 : POLLOUT)), 0});
    poll(files.data(), files.size(), int(patience.count()));
    const auto now = Line::Clock::now();
    const size_t count = lines_.size();
    for (size_t n = 0; n < count; ++n) {
        Line& line = *lines_[n];
        if (files[n + 1].revents & (POLLIN | POLLHUP | POLLERR))
            line.hear(now, [&](const Frame& frame) { sink_.heard(line, frame); });
        if (!line.hasEnded()) line.send(now);
        line.lookAfter(bounds_, now);
    }
    if (files[0].revents & POLLIN) acceptSome();
    forgetEnded();
}

void Port::acceptSome() {
    for (int n = 0; n < kMostAccepted; ++n) {
        PeerAddress from{};
        Descriptor socket = acceptFrom(listener_.get(), from);
        if (!socket) return;
        if (lines_.size() >= bounds_.most_lines) {
            ++refused_lines_;
            log(refused_, "a peer from " + textOf(from) +
                              " is turned away: " + std::to_string(lines_.size()) + " are here");
            continue;
        }
        lines_.push_back(std::make_unique<Line>(std::move(socket), from, wanted_, Line::Clock::now()));
        log(came_, "a peer has come from " + textOf(from));
        sink_.came(*lines_.back());
    }
}

void Port::forgetEnded() {
    for (const auto& line : lines_) {
        if (!line->hasEnded()) continue;
        log(gone_, "the peer from " + textOf(line->from()) + " is gone: " + printableLine(line->end_) + "; " +
                       std::to_string(line->sentBytes()) + " bytes sent, " +
                       std::to_string(line->droppedFrames()) + " messages dropped");
        sink_.gone(*line);
    }
    std::erase_if(lines_, [](const auto& line) { return line->hasEnded(); });
}

void Port::log(LogLimit& limit, const std::string& text) {
    const int64_t now_ns = std::chrono::nanoseconds(Line::Clock::now().time_since_epoch()).count();
    const int64_t left_out = limit.ask(now_ns);
    if (left_out < 0) return;
    spdlog::info("{}{}", text,
                 left_out > 0 ? "; " + std::to_string(left_out) + " lines were left out before" : "");
}

}  // namespace bonemill::igtl
