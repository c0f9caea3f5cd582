// This is where a session's link lies, a key of System V IPC, how the link refuses what it finds there, and
// who lives on it. It is for the start, not for the tick.
#pragma once

#include <sys/ipc.h>

#include <cstdint>
#include <string>

namespace bonemill {

// The two programs at the ends of a device link.
enum class LinkSide { kServer, kDaemon };

inline LinkSide peerOf(LinkSide side) noexcept {
    return side == LinkSide::kServer ? LinkSide::kDaemon : LinkSide::kServer;
}

inline const char* programOf(LinkSide side) noexcept {
    return side == LinkSide::kServer ? "haptic_server" : "device_daemon";
}

// The session's key. No two sessions share one, and the constant ("BM") keeps clear of the small numbers that
// other programs like. It never changes. One session has none: its key would be IPC_PRIVATE.
inline key_t linkKeyOf(uint32_t session) noexcept {
    return key_t(session ^ 0x424d0000u);
}

class LinkPlace {
  public:
    // Throws UserError for the one session that has no key.
    explicit LinkPlace(uint32_t session);

    key_t key() const noexcept { return key_; }
    // Throws a UserError that says where, what is wrong, and what to do.
    [[noreturn]] void refuse(const std::string& what) const;
    // Refuses what another user owns or made (who made it keeps every right to it), and what is open to
    // others. `option` is that of ipcrm which removes it: 'M' for memory, 'S' for semaphores.
    void checkOwner(const ipc_perm& owner, char option) const;
    // Says how the user removes what lies here.
    std::string removal(char option) const;

  private:
    uint32_t session_;
    key_t key_;
};

// The kernel keeps book here of who lives on a link: one semaphore per side, and one for the set-up.
//
// 0 is free and 1 is held. Each is taken with SEM_UNDO, so that the kernel frees it when its process dies,
// however it dies: a held one means a living process, and no pid can be mistaken. A stopped process keeps
// what it holds. The object is a handle and owns nothing.
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
