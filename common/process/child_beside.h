// A program that runs beside ours: what it prints is taken as it comes, and it ends with us.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace bonemill {

// It has a process group of its own, which gets SIGTERM when this object goes; the program itself gets it,
// too, when the thread that has started it dies in whatever way. It belongs to one thread, which lives as
// long as the program; not RT-safe.
class ChildBeside {
  public:
    // The first word is the program, a path or a name in $PATH. Throws std::system_error where no process can
    // be made.
    explicit ChildBeside(const std::vector<std::string>& words);
    ChildBeside(const ChildBeside&) = delete;
    ChildBeside& operator=(const ChildBeside&) = delete;
    ~ChildBeside();

    // Takes what has come, and notes the end. Never waits.
    void poll();
    void askToEnd() const;
    // Once it has ended and all it printed was taken: as a shell says it, 128 + signal where it was killed,
    // 127 where there is no such program.
    const std::optional<int>& exitCode() const { return exit_code_; }
    // The first kMostCaptured bytes (run_captured.h) of what it has printed so far.
    const std::string& out() const { return out_.text; }
    const std::string& err() const { return err_.text; }

  private:
    struct Outlet {
        int pipe = -1;  // -1: closed
        std::string text;
        void take();
    };

    pid_t child_ = -1;
    Outlet out_, err_;
    std::optional<int> exit_code_;
};

}  // namespace bonemill
