#include "common/ipc/link_place.h"

#include <pwd.h>
#include <unistd.h>

#include <iomanip>
#include <sstream>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

constexpr unsigned kModeOfOthers = 0077;

std::string nameOfUser(uid_t user) {
    const passwd* const entry = getpwuid(user);
    return (entry ? std::string(entry->pw_name) : "a user") + " (uid " + std::to_string(user) + ")";
}

std::string hexOf(key_t key) {
    std::ostringstream text;
    text << "0x" << std::hex << std::setw(8) << std::setfill('0') << uint32_t(key);
    return text.str();
}

std::string octalOf(unsigned mode) {
    std::ostringstream text;
    text << "0" << std::oct << mode;
    return text.str();
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
    return std::string("remove it with `ipcrm -") + option + " " + hexOf(key_) + "`";
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
        refuse(std::string(nounOf(option)) + " is open to other users (mode " + octalOf(owner.mode & 0777) +
               "), who could move the hand with it: " + removal(option) + ", or choose another --session");
    }
}

}  // namespace bonemill
