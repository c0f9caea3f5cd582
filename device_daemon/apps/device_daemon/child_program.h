// A program of ours that the daemon starts for itself: the emulator, or the bridge to a vendor's library. It
// listens at a UDP port of this machine, which it names in its first line.
//
// The child dies with the daemon. When it dies earlier it is started again, at the same port, after a second.
// Only for the thread that made it.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

#include "common/process/hand_order.h"

namespace bonemill {

// Returns the path of a program of ours. Throws UserError when it is missing.
std::string programPath(const std::string& name);

class ChildProgram {
  public:
    // Starts `name`, which lies beside this program or one folder above, with these words and --port. Throws
    // UserError when it is not there, ends at once (its last words go along) or says no port.
    ChildProgram(const std::string& name, std::vector<std::string> words);
    // From now on it hears tell(): the program listens to such orders.
    void listens() noexcept { does_listen_ = true; }
    // Nothing happens where the program does not listen.
    void tell(HandOrder order) noexcept;
    ChildProgram(const ChildProgram&) = delete;
    ChildProgram& operator=(const ChildProgram&) = delete;
    // Asks it to end, and ends it after two seconds.
    ~ChildProgram();

    uint16_t port() const noexcept { return port_; }
    // Called now and then: takes what it says, and starts it again if it has died of anything but its own
    // will.
    void lookAfter();
    // Waits until it has ended, two seconds at the most, and returns the last line that it said.
    std::string finish();

  private:
    void start();
    void awaitPort();
    void takeWords();
    bool hasEnded();

    std::string path_;
    std::vector<std::string> words_;
    uint16_t port_ = 0;
    pid_t pid_ = -1;
    bool does_listen_ = false;
    int output_ = -1;
    int exit_status_ = 0;
    int64_t ended_ns_ = 0;
    std::string text_;  // of the line that is not yet complete
    std::string last_line_;
};

}  // namespace bonemill
