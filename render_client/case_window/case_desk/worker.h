// Does long work beside the window, one piece at a time.
#pragma once

#include <functional>
#include <future>

namespace bonemill {

// It belongs to the thread of the window. Its end waits for the work that is under way.
class Worker {
  public:
    using Done = std::function<void()>;
    // Runs `work` in a thread of its own; what it returns is called by poll(). The worker must not be busy.
    void start(std::function<Done()> work);
    bool isBusy() const { return future_.valid(); }
    // If the work is over, calls what it returned, or throws what it threw.
    void poll();

  private:
    std::future<Done> future_;
};

}  // namespace bonemill
