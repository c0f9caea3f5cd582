// A program that many rely on runs its work in a process of its own, and looks after it: work that does not
// come round any more, or dies, is started again. For the start of a program, before its threads.
#pragma once

#include <chrono>
#include <functional>
#include <string>

namespace bonemill {

// By this the work says that it comes round.
class Heartbeat {
  public:
    explicit Heartbeat(int pipe) : pipe_(pipe) {}
    void beat() const noexcept;

  private:
    int pipe_;
};

struct SupervisorTimes {
    std::chrono::milliseconds round{100};    // how often it looks
    int most_silent_rounds = 20;             // of the work, once it has come round: 2 s
    int most_starting_rounds = 600;          // before: 1 min
    std::chrono::milliseconds to_end{1500};  // for work that is asked to, by SIGTERM
    std::chrono::milliseconds to_rest{
        1000};  // before it is started again, if it has not lasted ten times as long
};

// Runs `work` in a child process until it returns, again and again if need be, and returns its exit code in
// this one. `what` begins what the log says: "the gateway". The child returns, too, or throws what `work`
// throws: so the caller must go on the same way in both. `work` is told whether it is the first. Work that
// ends before it has come round once is not started again. When `should_stop`, the child gets SIGTERM, and is
// killed if it has not ended in time. Throws std::system_error where there is no process to be had.
int supervise(const std::string& what, const std::function<bool()>& should_stop,
              const std::function<int(const Heartbeat&, bool is_first)>& work,
              const SupervisorTimes& times = {});

}  // namespace bonemill
