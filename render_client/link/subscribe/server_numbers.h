// Which server a writer belongs to: its DDS participant, also after the writer has gone. For one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

namespace bonemill {

class ServerNumbers {
  public:
    // `participant` is that of the writer (dds::Reader::participantOf), 0 if it is not matched. A writer that
    // has gone is known from before; one that never was known stands for itself.
    uint64_t of(uint64_t participant, uint64_t writer) {
        const auto known = participants_.find(writer);
        if (participant == 0) return known == participants_.end() ? writer : known->second;
        if (participants_.size() >= kMaxWriters && known == participants_.end()) participants_.clear();
        participants_[writer] = participant;
        return participant;
    }
    void clear() { participants_.clear(); }

  private:
    static constexpr size_t kMaxWriters = 1024;  // bounds what invented ones can take

    std::map<uint64_t, uint64_t> participants_;  // by writer
};

}  // namespace bonemill
