// The outermost function of a program: what is thrown becomes a message and an exit code.
#pragma once

#include <exception>
#include <iostream>
#include <new>
#include <system_error>

#include "common/base/user_error.h"
#include "common/process/process_limits.h"

namespace bonemill {

// `body` returns the exit code.
template <class Body>
int runProgram(Body&& body) {
    try {
        requireFileHandles();
        return body();
    } catch (const UserError& error) {
        std::cerr << "error: " << error.what() << std::endl;
        return kUserErrorExitCode;
    } catch (const std::bad_alloc&) {
        std::cerr << "error: there is not enough memory; close other programs, or type: ulimit -v unlimited"
                  << std::endl;
        return 1;
    } catch (const std::system_error& error) {
        const bool is_of_thread = error.code() == std::errc::resource_unavailable_try_again;
        std::cerr << "error: "
                  << (is_of_thread ? "this PC grants no more threads or memory; see ulimit -u and ulimit -v"
                                   : error.what())
                  << std::endl;
        return 1;
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << std::endl;
        return 1;
    }
}

}  // namespace bonemill
