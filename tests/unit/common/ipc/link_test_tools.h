// Gives sessions that no other test uses, whose link is removed at the end, and raw access to what lies
// there.
#pragma once

#include <sys/sem.h>
#include <sys/shm.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <string>

#include "common/base/user_error.h"
#include "common/ipc/device_link.h"
#include "common/ipc/link_layout.h"

namespace bonemill {

// A test has at most 256 of them.
class TestSession {
  public:
    TestSession() : number_((1u << 31) + uint32_t(getpid()) * 256 + next()++) {}
    ~TestSession() {
        if (const int id = shmget(key(), 0, 0); id >= 0) shmctl(id, IPC_RMID, nullptr);
        if (const int id = semget(key(), 0, 0); id >= 0) semctl(id, 0, IPC_RMID);
    }
    TestSession(const TestSession&) = delete;
    TestSession& operator=(const TestSession&) = delete;

    uint32_t number() const { return number_; }
    key_t key() const { return linkKeyOf(number_); }
    bool hasMemory() const { return shmget(key(), 0, 0) >= 0; }
    bool hasSemaphores() const { return semget(key(), 0, 0) >= 0; }

    DeviceLink open(LinkSide side) const { return DeviceLink::create(number_, side); }
    // Returns the refusal, or "" without one.
    std::string refusalOf(LinkSide side) const {
        try {
            open(side);
        } catch (const UserError& error) {
            return error.what();
        }
        return "";
    }

  private:
    static uint32_t& next() {
        static uint32_t number = 0;
        return number;
    }
    uint32_t number_;
};

// Attaches to the memory of a session (or makes it), as a foreign program would.
class RawMemory {
  public:
    explicit RawMemory(const TestSession& session, size_t size = sizeof(LinkMemory), int mode = 0600)
        : id_(shmget(session.key(), session.hasMemory() ? 0 : size, IPC_CREAT | mode)),
          bytes_(static_cast<unsigned char*>(shmat(id_, nullptr, 0))) {
        if (bytes_ == reinterpret_cast<unsigned char*>(-1)) std::abort();
    }
    ~RawMemory() { shmdt(bytes_); }
    RawMemory(const RawMemory&) = delete;
    RawMemory& operator=(const RawMemory&) = delete;

    unsigned char* bytes() const { return bytes_; }
    template <class T>
    void write(const T& value, size_t offset) {
        std::memcpy(bytes_ + offset, &value, sizeof(T));
    }
    void remove() { shmctl(id_, IPC_RMID, nullptr); }

  private:
    int id_;
    unsigned char* bytes_;
};

// Holds a semaphore of a session as a living process does.
class HeldSemaphore {
  public:
    HeldSemaphore(const TestSession& session, LinkSemaphore number, int mode = 0600)
        : id_(semget(session.key(), kLinkSemaphoreCount, IPC_CREAT | mode)), number_(number) {
        add(1);
    }
    ~HeldSemaphore() { add(-1); }
    HeldSemaphore(const HeldSemaphore&) = delete;
    HeldSemaphore& operator=(const HeldSemaphore&) = delete;

  private:
    void add(short value) {
        sembuf operation{number_, value, SEM_UNDO};
        if (semop(id_, &operation, 1) != 0) std::abort();
    }
    int id_;
    unsigned short number_;
};

inline bool says(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace bonemill
