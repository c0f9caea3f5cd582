#include "common/dds/loopback_only.h"

#include <fcntl.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>

#include "common/base/user_error.h"

namespace bonemill::dds {
namespace {

constexpr char kLoopback[] = "lo";

std::set<int> openDescriptors() {
    std::set<int> descriptors;
    std::error_code error;
    for (std::filesystem::directory_iterator entry("/proc/self/fd", error), end; !error && entry != end;
         entry.increment(error))
        descriptors.insert(std::stoi(entry->path().filename().string()));
    // The folder's own is closed again: its number may be the next socket's.
    std::erase_if(descriptors, [](int descriptor) { return fcntl(descriptor, F_GETFD) < 0; });
    return descriptors;
}

int optionOf(int descriptor, int option) {
    int value = -1;
    socklen_t size = sizeof value;
    return getsockopt(descriptor, SOL_SOCKET, option, &value, &size) == 0 ? value : -1;
}

bool isUdp(int descriptor) {
    return optionOf(descriptor, SO_DOMAIN) == AF_INET && optionOf(descriptor, SO_TYPE) == SOCK_DGRAM;
}

}  // namespace

LoopbackOnly::LoopbackOnly() : before_(openDescriptors()) {}

int LoopbackOnly::tie() const {
    int count = 0;
    for (const int descriptor : openDescriptors()) {
        if (before_.contains(descriptor) || !isUdp(descriptor)) continue;
        if (setsockopt(descriptor, SOL_SOCKET, SO_BINDTODEVICE, kLoopback, sizeof kLoopback) != 0)
            throw UserError(std::string("profile one-pc: a socket cannot be tied to the loopback: ") +
                            std::strerror(errno));
        ++count;
    }
    return count;
}

}  // namespace bonemill::dds
