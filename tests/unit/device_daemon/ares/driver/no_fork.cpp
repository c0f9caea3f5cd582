// Loaded ahead of libc it ends every program that forks. The kernel copies the page table of whoever does,
// and a real-time thread beside has to wait for that; posix_spawn() shares the memory instead.
#include <stdlib.h>
#include <unistd.h>

extern "C" pid_t fork() noexcept {
    abort();
}
