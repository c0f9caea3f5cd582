// Works at several things at a time, each on a thread of its own, and takes what comes of them in their
// order: the result, and the first error that is met, are the same as from one thread. For start-up only.
#pragma once

#include <algorithm>
#include <deque>
#include <future>
#include <thread>
#include <vector>

namespace bonemill {

// How many at a time: one more than there are processors, so that none waits for what is being taken.
inline size_t mostAtATime() {
    constexpr size_t kMax = 9;
    return std::clamp<size_t>(size_t(std::thread::hardware_concurrency()) + 1, 2, kMax);
}

// Calls work(item) for each item, then take(item, what it returned), the latter on this thread. What work()
// throws is thrown when its turn comes; what comes after that is not taken.
template <class Item, class Work, class Take>
void workAhead(const std::vector<Item>& items, Work&& work, Take&& take) {
    std::deque<decltype(std::async(work, items[0]))> ahead;
    size_t next = 0;
    for (const Item& item : items) {
        // Where no thread can be had the work is done when its turn comes.
        for (; next < items.size() && ahead.size() < mostAtATime(); ++next)
            ahead.push_back(std::async(std::launch::async | std::launch::deferred,
                                       [&work, &ahead_item = items[next]] { return work(ahead_item); }));
        auto done = ahead.front().get();
        ahead.pop_front();
        take(item, std::move(done));
    }
}

}  // namespace bonemill
