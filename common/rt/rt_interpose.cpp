// These own definitions of the C library's heap and lock functions report a call, then do what the C library
// does. operator new, Eigen's allocator, strdup and reallocarray end in these; std::mutex, std::shared_mutex
// and std::condition_variable are made of these.
//
// What goes past them is not seen: futexes (std::atomic::wait, std::call_once, the guards of local statics,
// std::counting_semaphore), barriers, C11's mtx and cnd, and the locks that the C library takes for itself,
// as in stdio.
#include "common/rt/rt_interpose.h"

#include <dlfcn.h>
#include <pthread.h>
#include <semaphore.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>

using bonemill::rt_guard::onHeapCall;
using bonemill::rt_guard::onLockCall;

extern "C" {

// These are glibc's own names of the functions hidden by ours.
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* memory, size_t size);
void* __libc_memalign(size_t alignment, size_t size);
void* __libc_valloc(size_t size);
void* __libc_pvalloc(size_t size);
void __libc_free(void* memory);

void* malloc(size_t size) {
    onHeapCall("malloc");
    return __libc_malloc(size);
}

void* calloc(size_t count, size_t size) {
    onHeapCall("calloc");
    return __libc_calloc(count, size);
}

void* realloc(void* memory, size_t size) {
    onHeapCall("realloc");
    return __libc_realloc(memory, size);
}

void free(void* memory) {
    if (memory) onHeapCall("free");
    __libc_free(memory);
}

void* memalign(size_t alignment, size_t size) {
    onHeapCall("memalign");
    return __libc_memalign(alignment, size);
}

void* aligned_alloc(size_t alignment, size_t size) {
    onHeapCall("aligned_alloc");
    return __libc_memalign(alignment, size);
}

void* valloc(size_t size) {
    onHeapCall("valloc");
    return __libc_valloc(size);
}

void* pvalloc(size_t size) {
    onHeapCall("pvalloc");
    return __libc_pvalloc(size);
}

int posix_memalign(void** memory, size_t alignment, size_t size) {
    onHeapCall("posix_memalign");
    if (alignment % sizeof(void*) != 0 || (alignment & (alignment - 1)) != 0 || alignment == 0) return EINVAL;
    void* const result = __libc_memalign(alignment, size);
    if (!result) return ENOMEM;
    *memory = result;
    return 0;
}

}  // extern "C"

namespace {

void* nextOf(const char* name) noexcept {
    return dlsym(RTLD_NEXT, name);
}

// Under the same names the C library keeps older condition variables, of another layout.
void* nextOfCondition(const char* name) noexcept {
    void* const function = dlvsym(RTLD_NEXT, name, "GLIBC_2.3.2");
    return function ? function : nextOf(name);
}

// Returns the definition behind ours, looked up once. dlsym takes none of the locks below.
void* known(std::atomic<void*>& found, void* (*find)(const char*) noexcept, const char* name) noexcept {
    void* function = found.load(std::memory_order_relaxed);
    if (!function) {
        function = find(name);
        found.store(function, std::memory_order_relaxed);
    }
    return function;
}

}  // namespace

// `exceptions`: noexcept, or nothing where a thread can be cancelled.
#define BONEMILL_INTERPOSE(function, find, exceptions, parameters, arguments)                     \
    extern "C" int function parameters exceptions {                                               \
        static constinit std::atomic<void*> next_one{nullptr};                                    \
        onLockCall(#function);                                                                    \
        return reinterpret_cast<decltype(&function)>(known(next_one, find, #function)) arguments; \
    }
#define BONEMILL_INTERPOSE_LOCK(function, Object) \
    BONEMILL_INTERPOSE(function, nextOf, noexcept, (Object * object), (object))
#define BONEMILL_INTERPOSE_TIMED(function, Object) \
    BONEMILL_INTERPOSE(function, nextOf, noexcept, (Object * object, const timespec* until), (object, until))
#define BONEMILL_INTERPOSE_CLOCKED(function, Object) \
    BONEMILL_INTERPOSE(function, nextOf, noexcept,   \
                       (Object * object, clockid_t clock, const timespec* until), (object, clock, until))

BONEMILL_INTERPOSE_LOCK(pthread_mutex_lock, pthread_mutex_t)
BONEMILL_INTERPOSE_LOCK(pthread_mutex_trylock, pthread_mutex_t)
BONEMILL_INTERPOSE_TIMED(pthread_mutex_timedlock, pthread_mutex_t)
BONEMILL_INTERPOSE_CLOCKED(pthread_mutex_clocklock, pthread_mutex_t)
BONEMILL_INTERPOSE_LOCK(pthread_rwlock_rdlock, pthread_rwlock_t)
BONEMILL_INTERPOSE_LOCK(pthread_rwlock_wrlock, pthread_rwlock_t)
BONEMILL_INTERPOSE_LOCK(pthread_rwlock_tryrdlock, pthread_rwlock_t)
BONEMILL_INTERPOSE_LOCK(pthread_rwlock_trywrlock, pthread_rwlock_t)
BONEMILL_INTERPOSE_TIMED(pthread_rwlock_timedrdlock, pthread_rwlock_t)
BONEMILL_INTERPOSE_TIMED(pthread_rwlock_timedwrlock, pthread_rwlock_t)
BONEMILL_INTERPOSE_CLOCKED(pthread_rwlock_clockrdlock, pthread_rwlock_t)
BONEMILL_INTERPOSE_CLOCKED(pthread_rwlock_clockwrlock, pthread_rwlock_t)
BONEMILL_INTERPOSE_LOCK(pthread_spin_lock, pthread_spinlock_t)
BONEMILL_INTERPOSE_LOCK(pthread_spin_trylock, pthread_spinlock_t)

BONEMILL_INTERPOSE(pthread_cond_signal, nextOfCondition, noexcept, (pthread_cond_t * condition), (condition))
BONEMILL_INTERPOSE(pthread_cond_broadcast, nextOfCondition, noexcept, (pthread_cond_t * condition),
                   (condition))
BONEMILL_INTERPOSE(pthread_cond_wait, nextOfCondition, , (pthread_cond_t * condition, pthread_mutex_t* mutex),
                   (condition, mutex))
BONEMILL_INTERPOSE(pthread_cond_timedwait, nextOfCondition, ,
                   (pthread_cond_t * condition, pthread_mutex_t* mutex, const timespec* until),
                   (condition, mutex, until))
BONEMILL_INTERPOSE(pthread_cond_clockwait, nextOf, ,
                   (pthread_cond_t * condition, pthread_mutex_t* mutex, clockid_t clock,
                    const timespec* until),
                   (condition, mutex, clock, until))

BONEMILL_INTERPOSE(sem_wait, nextOf, , (sem_t * semaphore), (semaphore))
BONEMILL_INTERPOSE(sem_trywait, nextOf, noexcept, (sem_t * semaphore), (semaphore))
BONEMILL_INTERPOSE(sem_timedwait, nextOf, , (sem_t * semaphore, const timespec* until), (semaphore, until))
BONEMILL_INTERPOSE(sem_clockwait, nextOf, , (sem_t * semaphore, clockid_t clock, const timespec* until),
                   (semaphore, clock, until))
