// The kernel keeps book here of who lives on a link: one semaphore per side, and one for the set-up.
//
// 0 is free and 1 is held. Each is taken with SEM_UNDO, so that the kernel frees it when its process dies,
// however it dies: a held one means a living process, and no pid can be mistaken. A stopped process keeps
// what it holds. This is for start, end and watching, not for the tick; the object is a handle and owns
// nothing.
#pragma once

#include <cstdint>

#include "common/ipc/link_place.h"
#include "common/ipc/link_side.h"

namespace bonemill {

class LinkSemaphores {
  public:
    // Finds the set or makes it. Throws UserError when it is another user's, open to others or no link's.
    static LinkSemaphores open(const LinkPlace& place);

    // Keeps others from starting and leaving. False when the deadline (CLOCK_MONOTONIC) has passed, or when
    // the last to leave has removed the set: open it again.
    bool beginSetup(int64_t deadline_ns) const noexcept;
    // Removes the set if no process is on the link any more.
    void endSetup() const noexcept;
    // The process that is, or was last, in the set-up.
    int32_t pidInSetup() const noexcept;

    // False when a living process has this side.
    bool tryTake(LinkSide side) const noexcept;
    void giveBack(LinkSide side) const noexcept;
    bool isTaken(LinkSide side) const noexcept;
    // The process that has this side, or had it last.
    int32_t pidOf(LinkSide side) const noexcept;

  private:
    explicit LinkSemaphores(int id) noexcept : id_(id) {}

    int id_;
};

}  // namespace bonemill
