// What all stand-in libraries share: they do what the environment tells them, and write down every call.
//
// STAND_IN has words such as "heap block_ms=2 fails_from=300 fails_for=50"; STAND_IN_RECORD names the file of
// calls, one per line. Any thread may call these functions.
#pragma once

#include <fcntl.h>
#include <locale.h>
#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>

namespace stand_in {

// Returns the number of a word, 1 if it has none, and `otherwise` if it is not there.
inline double told(const std::string& word, double otherwise = 0) {
    static const std::string words = std::string(" ") + (getenv("STAND_IN") ? getenv("STAND_IN") : "") + " ";
    const size_t at = words.find(" " + word);
    if (at == std::string::npos) return otherwise;
    const char next = words[at + 1 + word.size()];
    if (next == '=') return std::atof(words.c_str() + at + word.size() + 2);
    return next == ' ' ? 1 : otherwise;
}

// Tells whether `count` has reached the number of a word that is there.
inline bool reached(const char* word, int count) {
    const double from = told(word, -1);
    return from >= 0 && count >= from;
}

__attribute__((format(printf, 1, 2))) inline void record(const char* format, ...) {
    static const int file = open(getenv("STAND_IN_RECORD") ? getenv("STAND_IN_RECORD") : "/dev/null",
                                 O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
    char line[256];
    va_list values;
    va_start(values, format);
    const int length = vsnprintf(line, sizeof(line), format, values);
    va_end(values);
    [[maybe_unused]] const ssize_t written = write(file, line, size_t(length));
}

inline void blockForEver() {
    while (true) pause();
}

// Every call goes through here: vendors' libraries take their time, allocate and lock.
inline void trouble() {
    if (const double ms = told("block_ms")) usleep(useconds_t(ms * 1000));
    if (told("heap")) {
        static std::mutex mutex;
        const std::lock_guard lock(mutex);
        const std::string text(1000, 'x');
        asm volatile("" ::"r"(text.data()) : "memory");
    }
}

// What a library may do to its process when it opens a device.
inline void takeOverProcess() {
    if (!told("takes_over")) return;
    mlockall(MCL_CURRENT);
    setlocale(LC_ALL, "");
}

// Ends the process, or this thread's use of it, when `count` calls have come.
inline void endAt(int count) {
    if (reached("abort_at", count)) abort();
    if (reached("crash_at", count)) raise(SIGSEGV);
    if (reached("hangs_at", count)) {
        record("hangs\n");
        blockForEver();
    }
}

}  // namespace stand_in
