// One bit per place, all of which are forgotten at once in a time that does not depend on their number: marks
// of a group that were made before that are wiped when the group is next written to.
//
// The constructor allocates; all else is RT-safe, for one thread.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace bonemill {

class PlaceMarks {
  public:
    explicit PlaceMarks(size_t places) : groups_((places + kPlaces - 1) / kPlaces) {}

    bool has(size_t place) const noexcept {
        const Group& group = groups_[place / kPlaces];
        return group.round == round_ && group.marks[place % kPlaces];
    }
    void set(size_t place) noexcept {
        Group& group = groups_[place / kPlaces];
        if (group.round != round_) group = {round_, {}};
        group.marks[place % kPlaces] = true;
    }
    void forget() noexcept { ++round_; }

  private:
    static constexpr size_t kPlaces = 4096;  // of a group: 512 bytes
    struct Group {
        uint64_t round = 0;
        std::bitset<kPlaces> marks;
    };
    std::vector<Group> groups_;
    uint64_t round_ = 0;
};

}  // namespace bonemill
