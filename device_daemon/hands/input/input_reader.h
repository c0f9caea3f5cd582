// A thread that reads a device which comes and goes: it opens it, hands over what it says, notices when it is
// unplugged, and tries again until it is back.
//
// The thread is an ordinary one, for everything that the real-time loop must not do.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <span>
#include <thread>

namespace bonemill {

// All of these are called on the reader's thread.
class InputSource {
  public:
    virtual ~InputSource() = default;

    // Returns a file descriptor that reads without blocking, which the reader closes; -1 while there is none.
    virtual int open() = 0;
    // False says that the device makes no sense, and hangs up.
    virtual bool take(std::span<const std::byte> bytes) = 0;
    // Comes at least every InputReader::kRest while the device is open. False hangs up.
    virtual bool rest() { return true; }
    // It is unplugged, or was hung up; its file is still open.
    virtual void lost() = 0;
};

class InputReader {
  public:
    static constexpr std::chrono::milliseconds kRest{20};
    static constexpr std::chrono::milliseconds kRetry{500};  // between attempts to open

    // The source must live longer.
    explicit InputReader(InputSource& source) : source_(source), thread_([this] { run(); }) {}
    // Waits for the thread, kRest at most.
    ~InputReader();
    InputReader(const InputReader&) = delete;
    InputReader& operator=(const InputReader&) = delete;

  private:
    void run();
    void readUntilLost(int file);

    InputSource& source_;
    std::atomic<bool> should_stop_ = false;
    std::thread thread_;  // the last member: what it uses is there before
};

}  // namespace bonemill
