// These own definitions of the C library's heap and lock functions report a call, then do what the C library
// does. operator new and Eigen's allocator end in malloc, std::mutex in pthread_mutex_lock, so that these
// few cover everything.
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

// Looks up the next definition of `name` behind ours, once. dlsym takes none of the locks below.
template <class Function>
Function* next(std::atomic<Function*>& known, const char* name) noexcept {
    Function* function = known.load(std::memory_order_relaxed);
    if (!function) {
        function = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
        known.store(function, std::memory_order_relaxed);
    }
    return function;
}

template <class Object>
using LockFunction = int(Object*);

}  // namespace

#define BONEMILL_INTERPOSE_LOCK(function, Object)                              \
    extern "C" int function(Object* object) noexcept {                         \
        static constinit std::atomic<LockFunction<Object>*> next_one{nullptr}; \
        onLockCall(#function);                                                 \
        return next(next_one, #function)(object);                              \
    }

BONEMILL_INTERPOSE_LOCK(pthread_mutex_lock, pthread_mutex_t)
BONEMILL_INTERPOSE_LOCK(pthread_mutex_trylock, pthread_mutex_t)
BONEMILL_INTERPOSE_LOCK(pthread_rwlock_rdlock, pthread_rwlock_t)
BONEMILL_INTERPOSE_LOCK(pthread_rwlock_wrlock, pthread_rwlock_t)
BONEMILL_INTERPOSE_LOCK(pthread_spin_lock, pthread_spinlock_t)

extern "C" int sem_wait(sem_t* semaphore) {
    static constinit std::atomic<LockFunction<sem_t>*> next_one{nullptr};
    onLockCall("sem_wait");
    return next(next_one, "sem_wait")(semaphore);
}
