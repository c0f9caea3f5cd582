// Gives link names that no other test or session uses, removed at the end, and raw access to the memory file.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "common/ipc/link_layout.h"

namespace bonemill {

class TestLinkName {
  public:
    TestLinkName()
        : session_((1u << 31) + uint32_t(getpid()) * 256 + next()++),
          name_("/bonemill_" + std::to_string(session_)) {}
    ~TestLinkName() { shm_unlink(name_.c_str()); }
    uint32_t session() const { return session_; }
    operator const std::string&() const { return name_; }
    const std::string& str() const { return name_; }
    bool exists() const { return access(("/dev/shm" + name_).c_str(), F_OK) == 0; }

  private:
    static uint32_t& next() {
        static uint32_t number = 0;
        return number;
    }
    uint32_t session_;
    std::string name_;
};

// Opens (or makes) the memory file as a foreign program would.
class RawMemory {
  public:
    explicit RawMemory(const std::string& name) : file_(shm_open(name.c_str(), O_RDWR | O_CREAT, 0600)) {}
    ~RawMemory() { close(file_); }
    RawMemory(const RawMemory&) = delete;
    RawMemory& operator=(const RawMemory&) = delete;

    void write(const void* data, size_t size, off_t offset) {
        if (pwrite(file_, data, size, offset) != ssize_t(size)) std::abort();
    }
    template <class T>
    void write(const T& value, off_t offset) {
        write(&value, sizeof(T), offset);
    }
    // Holds a lock byte as a living process of that side does.
    void hold(LinkLockByte byte) {
        struct flock lock {};
        lock.l_type = F_WRLCK;
        lock.l_whence = SEEK_SET;
        lock.l_start = byte;
        lock.l_len = 1;
        if (fcntl(file_, F_OFD_SETLK, &lock) != 0) std::abort();
    }

  private:
    int file_;
};

}  // namespace bonemill
