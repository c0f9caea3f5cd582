// A TCP port that speaks OpenIGTLink with several peers at once: takes their frames, sends them ours, and
// holds both within bounds of memory and time whatever a peer does. One who sends what makes no sense, or
// half a message, or does not read, is sent away; nobody waits for another.
//
// For one thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "common/igtl_wire/igtl_frame.h"
#include "common/log/log.h"
#include "common/tcp/listen.h"

namespace bonemill::igtl {

using Blob = std::shared_ptr<const std::string>;  // a whole frame; many peers share one

struct PortBounds {
    size_t most_lines = 16;
    // A message that has begun ends within this, and somebody who is sent something reads some of it.
    std::chrono::milliseconds frame_time{5000}, read_time{10000};
};

class Line {
  public:
    using Clock = std::chrono::steady_clock;
    Line(Descriptor socket, const PeerAddress& from, const std::vector<WantedType>& wanted,
         Clock::time_point now);

    // Queues a frame, if no more than `most_waiting` bytes wait already; false: it was dropped, and is
    // counted.
    bool say(Blob frame, size_t most_waiting);
    size_t waitingBytes() const noexcept { return waiting_bytes_; }
    uint64_t droppedFrames() const noexcept { return dropped_frames_; }
    uint64_t sentBytes() const noexcept { return sent_bytes_; }
    uint64_t heardFrames() const noexcept { return heard_frames_; }
    // It ends, for this reason, which is logged.
    void refuse(const std::string& why);
    bool hasEnded() const noexcept { return !end_.empty(); }
    const PeerAddress& from() const noexcept { return from_; }
    bool isOfThisPc() const noexcept;
    uint64_t number() const noexcept { return number_; }  // no other line has it

  private:
    friend class Port;
    void hear(Clock::time_point now, const std::function<void(const Frame&)>& use);
    void send(Clock::time_point now);
    void lookAfter(const PortBounds& bounds, Clock::time_point now);

    Descriptor socket_;
    const PeerAddress from_;
    const uint64_t number_;
    FrameReader reader_;
    std::deque<Blob> waiting_;
    size_t first_sent_ = 0;  // bytes of the first
    size_t waiting_bytes_ = 0;
    uint64_t dropped_frames_ = 0, sent_bytes_ = 0, heard_frames_ = 0;
    Clock::time_point whole_;     // when a message ended, or none had begun
    Clock::time_point progress_;  // when nothing waited, or some of it was taken
    std::string end_;
};

// Is called from Port::step().
class LineSink {
  public:
    virtual void came(Line& line) = 0;
    virtual void heard(Line& line, const Frame& frame) = 0;
    virtual void gone(const Line& line) = 0;

  protected:
    ~LineSink() = default;
};

class Port {
  public:
    // Listens there; port 0: any. Takes these messages, and no others. Throws UserError.
    Port(const std::string& address, uint16_t port, std::vector<WantedType> wanted, const PortBounds& bounds,
         LineSink& sink);

    // Takes and sends what can be, once something can, or after `patience`.
    void step(std::chrono::milliseconds patience);
    uint16_t number() const { return portOf(listener_.get()); }
    std::vector<std::unique_ptr<Line>>& lines() noexcept { return lines_; }
    uint64_t refusedLines() const noexcept { return refused_lines_; }

  private:
    void acceptSome();
    void forgetEnded();
    static void log(LogLimit& limit, const std::string& text);

    const std::vector<WantedType> wanted_;
    const PortBounds bounds_;
    LineSink& sink_;
    Descriptor listener_;
    std::vector<std::unique_ptr<Line>> lines_;
    uint64_t refused_lines_ = 0;
    LogLimit came_{20, 10'000'000'000}, gone_{20, 10'000'000'000}, refused_{5, 10'000'000'000};
};

}  // namespace bonemill::igtl
