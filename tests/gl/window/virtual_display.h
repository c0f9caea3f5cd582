// Starts a display in memory (Xvfb), gives hands for it (xdotool), and reads its clipboard (xclip).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace bonemill::test {

class VirtualDisplay {
  public:
    // The display is that of this process and its children from now on, and they remember of windows what was
    // set on it, not what the developer's home says. Throws std::runtime_error naming the package that is
    // missing.
    VirtualDisplay(int width, int height);

    // Runs xdotool with these words, such as {"key", "x"}, and returns when the display has taken it.
    void type(const std::vector<std::string>& words) const;
    // What another program than ours pastes; empty: nothing was copied.
    std::string clipboard() const;

  private:
    TemporaryFolder remembered_;
    std::unique_ptr<Process> server_;
};

}  // namespace bonemill::test
