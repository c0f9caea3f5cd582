#include "common/process/standard_output.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <string>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

// Says what is wrong with standard output; empty if nothing is. Streams that have failed once keep that, but
// not the reason.
std::string complaint() {
    errno = 0;
    const bool is_flushed = std::fflush(stdout) == 0;
    const int error = errno;
    std::cout.flush();
    if (is_flushed && std::ferror(stdout) == 0 && std::cout.good()) return {};
    return "standard output cannot be written (" +
           (error != 0 ? std::string(std::strerror(error)) : "its reader is gone, or its disk is full") + ")";
}

}  // namespace

void outliveReaders() noexcept {
    signal(SIGPIPE, SIG_IGN);
    // Lower numbers are filled first, so that each takes its own place.
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(stream, F_GETFD) < 0 && errno == EBADF)
            // The wrong way round: reading, or writing, fails as with a closed one.
            [[maybe_unused]]
            const int taken = open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

void requirePrinted() {
    if (const std::string what = complaint(); !what.empty())
        throw UserError(what + ": what was to be printed is not whole");
}

void forgiveUnprinted() noexcept {
    const std::string what = complaint();
    if (what.empty()) return;
    std::clearerr(stdout);
    std::cout.clear();
    std::cerr << "warning: " << what << "; the run itself was not touched by that" << std::endl;
}

}  // namespace bonemill
