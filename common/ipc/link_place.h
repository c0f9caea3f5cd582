// This is where a session's link lies, a key of System V IPC, and how the link refuses what it finds there.
// It is for the start, not for the tick.
#pragma once

#include <sys/ipc.h>

#include <cstdint>
#include <string>

namespace bonemill {

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

}  // namespace bonemill
