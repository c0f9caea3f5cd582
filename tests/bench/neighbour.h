// A program beside the tick that takes the cache they share: it goes through far more memory than that holds,
// as fast as it can, for as long as it lives.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <thread>
#include <vector>

namespace bonemill::bench {

class Neighbour {
  public:
    // It writes one word of each line; 0 bytes: there is no neighbour.
    explicit Neighbour(size_t bytes) : memory_(bytes / sizeof(uint64_t)) {
        if (memory_.empty()) return;
        thread_ = std::jthread([this](const std::stop_token& stop) {
            constexpr size_t kLine = 64 / sizeof(uint64_t);
            while (!stop.stop_requested())
                for (size_t n = 0; n < memory_.size(); n += kLine) memory_[n] += n;
        });
    }

  private:
    std::vector<uint64_t> memory_;
    std::jthread thread_;  // ends before the memory goes
};

}  // namespace bonemill::bench
