// It is thrown at start-up when the user's input is wrong: one message says what, where and what to do.
#pragma once

#include <stdexcept>
#include <string>

namespace bonemill {

// Programs print "error: " + what() on stderr and leave with kUserErrorExitCode. A running tick
// never throws it.
class UserError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

inline constexpr int kUserErrorExitCode = 2;

}  // namespace bonemill
