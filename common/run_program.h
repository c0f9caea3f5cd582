// The outermost function of a program: what is thrown becomes a message and an exit code.
#pragma once

#include <exception>
#include <iostream>

#include "common/user_error.h"

namespace bonemill {

// `body` returns the exit code.
template <class Body>
int runProgram(Body&& body) {
    try {
        return body();
    } catch (const UserError& error) {
        std::cerr << "error: " << error.what() << std::endl;
        return kUserErrorExitCode;
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << std::endl;
        return 1;
    }
}

}  // namespace bonemill
