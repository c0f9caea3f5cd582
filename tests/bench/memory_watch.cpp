#include "tests/bench/memory_watch.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/bench/processor_time.h"

namespace bonemill::bench {
namespace {

// Threads start processes, too, and each knows only its own.
size_t bytesOfTree(int pid) {
    size_t bytes = residentBytesOf(pid);
    std::error_code error;
    for (std::filesystem::directory_iterator task("/proc/" + std::to_string(pid) + "/task", error), end;
         !error && task != end; task.increment(error)) {
        std::ifstream children(task->path() / "children");
        for (int child = 0; children >> child;) bytes += bytesOfTree(child);
    }
    return bytes;
}

}  // namespace

MemoryWatch::MemoryWatch(int pid)
    : thread_([this, pid](const std::stop_token& stop) {
          while (!stop.stop_requested()) {
              peak_ = std::max(peak_.load(), bytesOfTree(pid));
              std::this_thread::sleep_for(std::chrono::milliseconds(5));
          }
      }) {}

}  // namespace bonemill::bench
