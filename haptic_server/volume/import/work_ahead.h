// Reads several files of a folder at a time, each on a thread of its own, and takes what comes of them in
// their order: what is made of a folder, and the first error that is met, are the same as from one thread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <future>
#include <thread>
#include <vector>

#include "haptic_server/volume/import/memory_cap.h"

namespace bonemill {

// So many at a time: one more than there are processors, so that none waits for what is being taken.
inline uint64_t filesAtATime() {
    constexpr uint64_t kMost = 9;
    return std::clamp<uint64_t>(uint64_t(std::thread::hardware_concurrency()) + 1, 2, kMost);
}

// Calls work(item) for each item, then take(item, what it returned), the latter on this thread. The work on
// one may take `bytes_each` of memory, all that is taken `bytes_taken` (memory_cap.h). What work() throws is
// thrown when its turn comes; what comes after that is not taken.
template <class Item, class Work, class Take>
void workAhead(const std::vector<Item>& items, uint64_t bytes_each, uint64_t bytes_taken, Work&& work,
               Take&& take) {
    constexpr uint64_t kThread = uint64_t(256) << 20;  // its stack and its heap, most of it never used
    const MemoryCap cap(filesAtATime() * (bytes_each + kThread) + bytes_taken);
    std::deque<decltype(std::async(work, items[0]))> ahead;
    size_t next = 0;
    for (const Item& item : items) {
        // Where no thread can be had the work is done when its turn comes.
        for (; next < items.size() && ahead.size() < filesAtATime(); ++next)
            ahead.push_back(std::async(std::launch::async | std::launch::deferred,
                                       [&work, &ahead_item = items[next]] { return work(ahead_item); }));
        auto done = ahead.front().get();
        ahead.pop_front();
        take(item, std::move(done));
    }
}

}  // namespace bonemill
