#include "common/ipc/link_place.h"

#include <pwd.h>
#include <sys/sem.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>

#include "common/base/user_error.h"
#include "common/ipc/link_layout.h"
#include "common/rt/clock.h"
#include "common/text/printed_text.h"

namespace bonemill {
namespace {

// The C library leaves it to us to define it.
union SemaphoreArgument {
    int value;
    semid_ds* status;
};

LinkSemaphore semaphoreOf(LinkSide side) noexcept {
    return side == LinkSide::kServer ? kServerSemaphore : kDaemonSemaphore;
}

// Waits for 0 and adds 1, as one operation of the kernel.
bool takeSemaphore(int id, LinkSemaphore number, const timespec* patience) noexcept {
    const short flags = patience ? 0 : IPC_NOWAIT;
    sembuf operations[] = {{number, 0, flags}, {number, 1, short(flags | SEM_UNDO)}};
    return semtimedop(id, operations, std::size(operations), patience) == 0;
}

void freeSemaphore(int id, LinkSemaphore number) noexcept {
    sembuf operation{number, -1, IPC_NOWAIT | SEM_UNDO};
    semop(id, &operation, 1);
}

semid_ds setStatus(int id, int how) noexcept {
    semid_ds status{};
    semctl(id, 0, how, SemaphoreArgument{.status = &status});
    return status;
}

[[noreturn]] void refuseStranger(const LinkPlace& place) {
    place.refuse("another program uses its set of semaphores; choose another --session, or " +
                 place.removal('S'));
}

int findOrMake(const LinkPlace& place) {
    const int id = semget(place.key(), kLinkSemaphoreCount, IPC_CREAT | 0600);
    if (id >= 0) return id;
    const int error = errno;
    if (error == EACCES) {
        const int foreign = semget(place.key(), 0, 0);
        if (foreign >= 0) place.checkOwner(setStatus(foreign, SEM_STAT_ANY).sem_perm, 'S');
    }
    if (error == EINVAL) refuseStranger(place);  // it has fewer
    place.refuse(std::string("its semaphores cannot be made: ") + std::strerror(error) +
                 "; `ipcs -u` shows what the system holds, `ipcs -l` its limits");
}

constexpr unsigned kModeOfOthers = 0077;

std::string nameOfUser(uid_t user) {
    const passwd* const entry = getpwuid(user);
    return (entry ? std::string(entry->pw_name) : "a user") + " (uid " + std::to_string(user) + ")";
}

const char* nounOf(char option) {
    return option == 'M' ? "its shared memory" : "its set of semaphores";
}

}  // namespace

LinkPlace::LinkPlace(uint32_t session) : session_(session), key_(linkKeyOf(session)) {
    if (key_ == IPC_PRIVATE) refuse("this one number cannot be used; choose another --session");
}

void LinkPlace::refuse(const std::string& what) const {
    throw UserError("device link of session " + std::to_string(session_) + ": " + what);
}

std::string LinkPlace::removal(char option) const {
    return std::string("remove it with `ipcrm -") + option + " " + printed("0x%08x", unsigned(key_)) + "`";
}

void LinkPlace::checkOwner(const ipc_perm& owner, char option) const {
    const uid_t self = geteuid();
    if (owner.uid != self || owner.cuid != self) {
        refuse(std::string(nounOf(option)) + " belongs to " +
               nameOfUser(owner.uid != self ? owner.uid : owner.cuid) + ", not to " + nameOfUser(self) +
               ": run haptic_server and device_daemon as the same user, choose another --session, or have "
               "that user stop their programs or " +
               removal(option));
    }
    if (owner.mode & kModeOfOthers) {
        refuse(std::string(nounOf(option)) + " is open to other users (mode " +
               printed("0%o", unsigned(owner.mode & 0777)) +
               "), who could move the hand with it: " + removal(option) + ", or choose another --session");
    }
}

LinkSemaphores LinkSemaphores::open(const LinkPlace& place) {
    const int id = findOrMake(place);
    const semid_ds status = setStatus(id, IPC_STAT);
    const bool is_removed = status.sem_nsems == 0;  // just now, by the last to leave; beginSetup() finds that
    if (!is_removed) place.checkOwner(status.sem_perm, 'S');
    if (!is_removed && status.sem_nsems != kLinkSemaphoreCount) refuseStranger(place);
    return LinkSemaphores(id);
}

bool LinkSemaphores::beginSetup(int64_t deadline_ns) const noexcept {
    for (;;) {
        const timespec patience = timespecOfNs(std::max<int64_t>(0, deadline_ns - monotonicNowNs()));
        if (takeSemaphore(id_, kSetupSemaphore, &patience)) return true;
        if (errno != EINTR) return false;
    }
}

void LinkSemaphores::endSetup() const noexcept {
    if (isTaken(LinkSide::kServer) || isTaken(LinkSide::kDaemon)) {
        freeSemaphore(id_, kSetupSemaphore);
    } else {
        semctl(id_, 0, IPC_RMID);  // whoever waits for it is woken
    }
}

int32_t LinkSemaphores::pidInSetup() const noexcept {
    return semctl(id_, kSetupSemaphore, GETPID);
}

bool LinkSemaphores::tryTake(LinkSide side) const noexcept {
    return takeSemaphore(id_, semaphoreOf(side), nullptr);
}

void LinkSemaphores::giveBack(LinkSide side) const noexcept {
    freeSemaphore(id_, semaphoreOf(side));
}

bool LinkSemaphores::isTaken(LinkSide side) const noexcept {
    return semctl(id_, semaphoreOf(side), GETVAL) > 0;
}

int32_t LinkSemaphores::pidOf(LinkSide side) const noexcept {
    return semctl(id_, semaphoreOf(side), GETPID);
}

}  // namespace bonemill
