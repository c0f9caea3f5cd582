// Bounded lists of senders. A sender that invents names drives out only its own entries.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>

namespace bonemill {

struct RoomLimits {
    size_t most;           // entries
    size_t most_of_owner;  // of one of those who speak for them
};

// Before an entry of this owner comes to the list, makes room for it: the least recently heard of the owner
// goes where it has its share, and else, where the list is full, that of who has most. `owner_of` and
// `heard_at` are projections of an entry, to uint64_t and to what grows with time. It looks through the whole
// list.
template <class List, class OwnerOf, class HeardAt>
void makeRoomFor(uint64_t owner, List& list, const RoomLimits& limits, OwnerOf owner_of, HeardAt heard_at) {
    const auto forgetOldestOf = [&](uint64_t of) {
        auto oldest = list.end();
        for (auto entry = list.begin(); entry != list.end(); ++entry)
            if (std::invoke(owner_of, *entry) == of &&
                (oldest == list.end() || std::invoke(heard_at, *entry) < std::invoke(heard_at, *oldest)))
                oldest = entry;
        list.erase(oldest);
    };
    const auto is_its = [&](const auto& entry) { return std::invoke(owner_of, entry) == owner; };
    if (size_t(std::ranges::count_if(list, is_its)) >= limits.most_of_owner) return forgetOldestOf(owner);
    if (list.size() < limits.most) return;
    std::map<uint64_t, size_t> counts;
    for (const auto& entry : list) ++counts[std::invoke(owner_of, entry)];
    const auto count = [](const auto& counted) { return counted.second; };
    forgetOldestOf(std::ranges::max_element(counts, {}, count)->first);
}

}  // namespace bonemill
