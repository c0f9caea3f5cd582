// The memory of a link: a System V segment, attached while the object lives.
//
// The kernel fixes the size of such a segment when it is made, and, unlike a file, it is not cut short under
// a program that reads it (SIGBUS). Owner, maker and mode are checked before it is touched. This is for start
// and end; only access to what is attached is for the tick. Whoever calls has the set-up to itself
// (LinkSemaphores).
#pragma once

#include <utility>

#include "common/ipc/link_layout.h"
#include "common/ipc/link_place.h"

namespace bonemill {

class LinkSegment {
  public:
    // Makes empty memory, in place of what the dead have left. Throws UserError when what lies there is not
    // ours to remove.
    static LinkSegment make(const LinkPlace& place);
    // Attaches to the memory of a living peer. Throws UserError when it cannot be shared with `side`.
    static LinkSegment join(const LinkPlace& place, LinkSide side);

    LinkSegment(LinkSegment&& other) noexcept
        : id_(other.id_), memory_(std::exchange(other.memory_, nullptr)) {}
    LinkSegment& operator=(LinkSegment&&) = delete;
    ~LinkSegment();

    // Whoever is still attached keeps it; no new process finds it.
    void remove() const noexcept;

    explicit operator bool() const noexcept { return memory_; }
    LinkMemory& operator*() const noexcept { return *memory_; }
    LinkMemory* operator->() const noexcept { return memory_; }

  private:
    LinkSegment(int id, LinkMemory* memory) noexcept : id_(id), memory_(memory) {}

    int id_;
    LinkMemory* memory_;
};

}  // namespace bonemill
